// Start and exception vectors of an AArch64 processor (Arm Architecture Reference Manual DDI 0487). In assembly
// because there is no stack yet, or none that is known to be intact.
//
// Three stacks: the program runs on SP_EL0, interrupts on SP_EL1, so that each has a guard page of its own; the report
// of a fault runs on a third one.
    .arch armv8-a

    .section .text.start, "ax", %progbits
    .global _start
    .type _start, %function
_start:
    mrs x0, mpidr_el1               // one processor is enough
    and x0, x0, #0xFF
    cbnz x0, park
    mrs x19, CurrentEL
    cmp x19, #(1 << 2)
    b.eq at_el1
    cmp x19, #(2 << 2)
    b.ne park                       // EL3: a secure monitor has to come first

    // From a hypervisor's level down to EL1, with all it might trap given away.
    mov x0, #(1 << 31)              // HCR_EL2.RW: EL1 is AArch64
    msr hcr_el2, x0
    mov x0, #0x33FF                 // CPTR_EL2: no trap of the FPU
    msr cptr_el2, x0
    msr cntvoff_el2, xzr            // the virtual counter is the physical one
    mov x0, #3
    msr cnthctl_el2, x0
    mov x0, #0x3C5                  // EL1 on its own stack, all interrupts masked
    msr spsr_el2, x0
    adr x0, at_el1
    msr elr_el2, x0
    eret

at_el1:
    ldr x0, =0x30D00800             // SCTLR_EL1: MMU and caches off, little-endian; the bits that have to be 1
    msr sctlr_el1, x0
    mov x0, #(3 << 20)              // CPACR_EL1.FPEN: the tick calculates in floating point
    msr cpacr_el1, x0
    ldr x0, =vectors
    msr vbar_el1, x0
    isb
    ldr x0, =interrupt_stack_top
    mov sp, x0
    msr spsel, #0
    ldr x0, =stack_top
    mov sp, x0

    ldr x0, =thread_data - 16 // where the C library's mathematics finds its errno (AAELF64, "thread-local storage")
    msr tpidr_el0, x0
    ldr x0, =zero_begin
    ldr x1, =zero_end
1:  cmp x0, x1
    b.hs 2f
    stp xzr, xzr, [x0], #16
    b 1b
2:  ldr x0, =first_level            // of reset_cause.cpp
    str x19, [x0]
    bl start_board
    bl main
    bl end_of_program
park:
    wfe
    b park
    .size _start, . - _start

// --- vectors: sixteen entries of 128 bytes (D1.10.2). What has no business here is reported with its number.
    .macro report number
    .balign 128
    msr tpidr_el1, x0
    mov x0, #\number
    b report_exception
    .endm

    .section .text.vectors, "ax", %progbits
    .balign 2048
vectors:
    report 0                        // from the program: fault
    .balign 128
    b interrupt
    report 2                        // watchdog
    report 3
    report 4                        // from a handler: fault
    report 5
    report 6                        // watchdog
    report 7
    report 8                        // from below EL1, where nothing runs
    report 9
    report 10
    report 11
    report 12
    report 13
    report 14
    report 15

// --- interrupt: everything a C++ function may change is saved, the whole FPU included, for the tick runs here.
    .macro each_pair instruction first, second, offset
    \instruction \first, \second, [sp, #\offset]
    .endm
    .macro general_registers instruction
    each_pair \instruction x0, x1, 0
    each_pair \instruction x2, x3, 16
    each_pair \instruction x4, x5, 32
    each_pair \instruction x6, x7, 48
    each_pair \instruction x8, x9, 64
    each_pair \instruction x10, x11, 80
    each_pair \instruction x12, x13, 96
    each_pair \instruction x14, x15, 112
    each_pair \instruction x16, x17, 128
    each_pair \instruction x18, x30, 144
    .endm
    .macro fpu_registers instruction
    each_pair \instruction q0, q1, 0
    each_pair \instruction q2, q3, 32
    each_pair \instruction q4, q5, 64
    each_pair \instruction q6, q7, 96
    each_pair \instruction q8, q9, 128
    each_pair \instruction q10, q11, 160
    each_pair \instruction q12, q13, 192
    each_pair \instruction q14, q15, 224
    each_pair \instruction q16, q17, 256
    each_pair \instruction q18, q19, 288
    each_pair \instruction q20, q21, 320
    each_pair \instruction q22, q23, 352
    each_pair \instruction q24, q25, 384
    each_pair \instruction q26, q27, 416
    each_pair \instruction q28, q29, 448
    each_pair \instruction q30, q31, 480
    .endm

    .section .text.interrupt, "ax", %progbits
    .type interrupt, %function
interrupt:
    sub sp, sp, #176
    general_registers stp
    mrs x0, fpcr
    mrs x1, fpsr
    stp x0, x1, [sp, #160]
    sub sp, sp, #512
    fpu_registers stp
    msr daifclr, #1                 // the watchdog may bite in here, too: it never comes back
    bl handle_interrupt
    fpu_registers ldp
    add sp, sp, #512
    ldp x0, x1, [sp, #160]
    msr fpcr, x0
    msr fpsr, x1
    general_registers ldp
    add sp, sp, #176
    eret
    .size interrupt, . - interrupt

// --- what is not handled: registers into memory of their own, then words. x0 is in TPIDR_EL1, the vector's number in
// x0; two registers of the FPU that the report does not show, and a function call does not keep, hold x1 and x2.
    .section .text.report_exception, "ax", %progbits
    .type report_exception, %function
report_exception:
    fmov d30, x1
    fmov d31, x2
    mrs x1, elr_el1                 // a semihosting request without a debugger returns -1
    ldr x2, =semihosting_breakpoint
    cmp x1, x2
    b.eq unheard_request
    ldr x1, =fault_registers        // x0 ... x30, then the stack pointers
    fmov x2, d31
    stp x2, x3, [x1, #16]
    stp x4, x5, [x1, #32]
    stp x6, x7, [x1, #48]
    stp x8, x9, [x1, #64]
    stp x10, x11, [x1, #80]
    stp x12, x13, [x1, #96]
    stp x14, x15, [x1, #112]
    stp x16, x17, [x1, #128]
    stp x18, x19, [x1, #144]
    stp x20, x21, [x1, #160]
    stp x22, x23, [x1, #176]
    stp x24, x25, [x1, #192]
    stp x26, x27, [x1, #208]
    stp x28, x29, [x1, #224]
    mrs x2, sp_el0
    stp x30, x2, [x1, #240]
    mov x2, sp
    str x2, [x1, #256]
    mrs x2, tpidr_el1
    fmov x3, d30
    stp x2, x3, [x1]
    ldr x2, =fault_stack_top
    mov sp, x2
    b report_exception_in_words     // x0: vector, x1: registers; does not return
unheard_request:
    add x1, x1, #4
    msr elr_el1, x1
    mov x0, #-1
    eret
    .size report_exception, . - report_exception
