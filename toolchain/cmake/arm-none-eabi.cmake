# Cross compilation for the Cortex-M boards with the GNU compiler. VOLCOMP_BOARD selects the processor:
#   m7   mps2-an500, Cortex-M7, double-precision FPU
#   m4   mps2-an386, Cortex-M4F, single-precision FPU: double is done in software
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VOLCOMP_BOARD)

if(VOLCOMP_BOARD STREQUAL "m7")
  set(volcomp_cpu "-mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-d16")
elseif(VOLCOMP_BOARD STREQUAL "m4")
  set(volcomp_cpu "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16")
else()
  message(FATAL_ERROR "VOLCOMP_BOARD is \"${VOLCOMP_BOARD}\": configure with the preset \"m7\" or \"m4\".")
endif()
set(VOLCOMP_BOARD_FOLDER mps2)

set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_ASM_COMPILER arm-none-eabi-gcc)

# Every function and object in a section of its own, so that the linker leaves out what is not used. -Wno-psabi: one
# compiler makes the whole image, so an interface that differed before GCC 7.1 does not matter. -fstack-usage writes the
# frame of every function beside its object file; -g is for the debugger and costs no flash.
set(CMAKE_CXX_FLAGS_INIT
  "${volcomp_cpu} -ffunction-sections -fdata-sections -fno-use-cxa-atexit -fno-unwind-tables -fno-asynchronous-unwind-tables -fstack-usage -g -Wno-psabi")
set(CMAKE_ASM_FLAGS_INIT "${volcomp_cpu} -g")
set(CMAKE_EXE_LINKER_FLAGS_INIT "${volcomp_cpu}")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
# ctest starts every image through it.
set(CMAKE_CROSSCOMPILING_EMULATOR "${CMAKE_CURRENT_LIST_DIR}/../run-firmware;${VOLCOMP_BOARD}")
