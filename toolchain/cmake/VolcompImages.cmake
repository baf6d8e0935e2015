# volcomp_add_image(NAME [WHOLE_BOARD | BOARD TARGET] SOURCE...): a program for the board of this build, firmware/NAME-BOARD.elf.
#
# The folder of the board provides the target volcomp_board: startup, linker script and hal. No library offers
# _sbrk, so an image that uses the heap does not link; neither does one with a warning of the linker.
# WHOLE_BOARD is for tests that hold more than a product would: volcomp_whole_board declares all memory there is. Every other
# image is refused if it links volcomp_metrology. BOARD: another memory of the board than volcomp_board.
function(volcomp_add_image name)
  cmake_parse_arguments(PARSE_ARGV 1 image "WHOLE_BOARD" "BOARD" "")
  set(board volcomp_board)
  if(image_BOARD)
    set(board ${image_BOARD})
  endif()
  if(image_WHOLE_BOARD)
    set(board volcomp_whole_board)
  endif()
  add_executable(${name} ${image_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE ${board} volcomp_flags volcomp_target_rules)
  target_link_options(${name} PRIVATE
    -nostartfiles
    -Wl,--gc-sections -Wl,--fatal-warnings -Wl,--print-memory-usage
    "-Wl,-Map=$<TARGET_FILE_DIR:${name}>/$<TARGET_FILE_BASE_NAME:${name}>.map")
  set_target_properties(${name} PROPERTIES
    OUTPUT_NAME "${name}-${VOLCOMP_BOARD}"
    SUFFIX .elf
    RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/firmware")
  if(NOT image_WHOLE_BOARD)
    add_custom_command(TARGET ${name} POST_BUILD VERBATIM COMMAND "${CMAKE_COMMAND}"
      "-DMAP=$<TARGET_FILE_DIR:${name}>/$<TARGET_FILE_BASE_NAME:${name}>.map"
      -P "${PROJECT_SOURCE_DIR}/toolchain/cmake/VolcompCheckMap.cmake")
  endif()
endfunction()
