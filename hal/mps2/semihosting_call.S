// int semihosting_call(int operation, const void* arguments): the breakpoint that a debugger or an emulator takes for
// a request (Arm "Semihosting for AArch32 and AArch64"). Without either it becomes a HardFault, whose handler knows
// this address, answers -1 and goes on.
    .syntax unified
    .thumb
    .section .text.semihosting_call, "ax", %progbits
    .global semihosting_call
    .global semihosting_breakpoint
    .type semihosting_call, %function
semihosting_call:
semihosting_breakpoint:         // without the Thumb bit: an address, not a function
    bkpt 0xAB
    bx lr
    .size semihosting_call, . - semihosting_call
