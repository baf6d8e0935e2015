# volcomp_reference: pages about the public headers, made from their comments, in reference/html of the build folder. A
# warning of Doxygen fails the target. Without Doxygen the target fails with a message; nothing else needs it.
find_program(VOLCOMP_DOXYGEN NAMES doxygen DOC "makes the reference of the public headers")
set(volcomp_doxyfile "${PROJECT_BINARY_DIR}/reference/Doxyfile")
configure_file(toolchain/reference/Doxyfile.in "${volcomp_doxyfile}" @ONLY)
if(VOLCOMP_DOXYGEN)
  add_custom_target(volcomp_reference
    COMMAND "${VOLCOMP_DOXYGEN}" "${volcomp_doxyfile}"
    COMMENT "Reference of the public headers: ${PROJECT_BINARY_DIR}/reference/html/index.html"
    VERBATIM)
else()
  add_custom_target(volcomp_reference
    COMMAND "${CMAKE_COMMAND}" -E echo "The reference needs doxygen: install it (toolchain/setup.sh) and configure again."
    COMMAND "${CMAKE_COMMAND}" -E false
    VERBATIM)
endif()
