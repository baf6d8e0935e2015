// int64_t semihosting_call(int64_t operation, const void* arguments): the instruction that a debugger or an emulator
// takes for a request (Arm "Semihosting for AArch32 and AArch64"). Without either it is undefined; the handler of that
// exception knows this address, answers -1 and goes on.
    .section .text.semihosting_call, "ax", %progbits
    .global semihosting_call
    .global semihosting_breakpoint
    .type semihosting_call, %function
semihosting_call:
semihosting_breakpoint:
    hlt #0xF000
    ret
    .size semihosting_call, . - semihosting_call
