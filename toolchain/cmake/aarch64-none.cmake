# Cross compilation for bare AArch64 with the GNU compiler for Linux: Debian has none for machines without an operating
# system. Its headers serve; nothing of its C library is linked (firmware/boards/virt-a53/c_library.cpp), so a program
# that uses the heap does not link.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(VOLCOMP_BOARD a53)
set(VOLCOMP_BOARD_FOLDER virt-a53)

set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_ASM_COMPILER aarch64-linux-gnu-gcc)

# The atomic read-modify-write helpers of libgcc query the Linux kernel for the processor's features:
# -mno-outline-atomics. Every function and object in a section of its own, so that the linker leaves out what is not
# used. -fstack-usage writes the frame of every function beside its object file; -g is for the debugger.
set(CMAKE_CXX_FLAGS_INIT
  "-mcpu=cortex-a53 -mno-outline-atomics -fno-pie -fno-stack-protector -ffunction-sections -fdata-sections -fno-use-cxa-atexit -fno-unwind-tables -fno-asynchronous-unwind-tables -fstack-usage -g")
set(CMAKE_ASM_FLAGS_INIT "-mcpu=cortex-a53 -g")
# Sine and cosine of the commissioning code come from the C library's mathematics.
set(CMAKE_CXX_STANDARD_LIBRARIES "-lm -lgcc")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static -no-pie -nostdlib -Wl,--build-id=none -mfix-cortex-a53-835769 -mfix-cortex-a53-843419")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
# ctest starts every image through it.
set(CMAKE_CROSSCOMPILING_EMULATOR "${CMAKE_CURRENT_LIST_DIR}/../run-firmware;${VOLCOMP_BOARD}")
