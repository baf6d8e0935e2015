# volcomp_offset_cases(TARGET): its sources include "offset_cases.inc", the cases of limited offsets as numbers.
set(VOLCOMP_OFFSET_CASES_FOLDER "${CMAKE_CURRENT_LIST_DIR}")
function(volcomp_offset_cases target)
  set(program "${VOLCOMP_OFFSET_CASES_FOLDER}/offset_cases_inc.py")
  set(cases "${VOLCOMP_OFFSET_CASES_FOLDER}/../data/cases/offset-limits.json")
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${target}-cases")
  file(MAKE_DIRECTORY "${folder}")
  add_custom_command(OUTPUT "${folder}/offset_cases.inc"
    COMMAND /usr/bin/python3 "${program}" "${cases}" > "${folder}/offset_cases.inc"
    DEPENDS "${program}" "${cases}" VERBATIM)
  target_sources(${target} PRIVATE "${folder}/offset_cases.inc")
  target_include_directories(${target} PRIVATE "${folder}")
endfunction()
