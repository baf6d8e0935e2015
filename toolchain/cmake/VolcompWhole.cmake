# volcomp_link_whole(TARGET LIBRARY...): TARGET holds every member of these libraries, used or not. It is linked to be read by
# toolchain/evidence, which proves from it what is promised of all their code, and never run.
function(volcomp_link_whole target)
  target_link_libraries(${target} PRIVATE -Wl,--whole-archive ${ARGN} -Wl,--no-whole-archive)
  target_link_options(${target} PRIVATE -Wl,--no-gc-sections)
  set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
endfunction()

# volcomp_add_whole_program(NAME LIBRARY...): the same for this computer, firmware/NAME-host.elf.
function(volcomp_add_whole_program name)
  file(CONFIGURE OUTPUT ${name}.cpp CONTENT "int main() { return 0; }\n")
  add_executable(${name} "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp")
  volcomp_link_whole(${name} ${ARGN})
  target_link_options(${name} PRIVATE "-Wl,-Map=${PROJECT_BINARY_DIR}/firmware/${name}-host.map")
  set_target_properties(${name} PROPERTIES
    OUTPUT_NAME "${name}-host"
    SUFFIX .elf
    RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/firmware")
endfunction()
