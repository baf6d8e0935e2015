// Vector table and reset (Armv7-M Architecture Reference Manual DDI 0403, B1.5). In assembly because the stack is
// painted and the FPU is off while it runs.
    .syntax unified
    .thumb

    .section .vectors, "a", %progbits
    .word stack_top
    .word Reset_Handler
    .word NMI_Handler
    .word HardFault_Handler
    .word MemManage_Handler
    .word BusFault_Handler
    .word UsageFault_Handler
    .word 0
    .word 0
    .word 0
    .word 0
    .word SVC_Handler
    .word DebugMon_Handler
    .word 0
    .word PendSV_Handler
    .word SysTick_Handler
    // Interrupts of the board (Arm DAI 0385, 0386, 0500, "interrupt assignments"). Unused ones end in the report of
    // an unexpected interrupt.
    .word UARTRX0_Handler
    .word UARTTX0_Handler
    .rept 6
    .word Unexpected_Handler
    .endr
    .word TIMER0_Handler
    .word TIMER1_Handler
    .rept 22
    .word Unexpected_Handler
    .endr

// An image overrides what it handles by a function of the same name.
    .macro unused_by_default name
    .weak \name
    .thumb_set \name, Unexpected_Handler
    .endm
    unused_by_default SVC_Handler
    unused_by_default DebugMon_Handler
    unused_by_default PendSV_Handler
    unused_by_default SysTick_Handler
    unused_by_default UARTRX0_Handler
    unused_by_default UARTTX0_Handler
    unused_by_default TIMER0_Handler
    unused_by_default TIMER1_Handler

    .section .text.Reset_Handler, "ax", %progbits
    .global Reset_Handler
    .type Reset_Handler, %function
Reset_Handler:
    bl check_processor          // before the first instruction that another processor may lack

    ldr r0, =0xE000ED88         // CPACR (B3.2.20): full access to the FPU
    ldr r1, [r0]
    orr r1, r1, #(0xF << 20)
    str r1, [r0]
    dsb
    isb

    ldr r0, =stack_bottom
    ldr r1, =stack_top
    ldr r2, =0xDEADBEEF         // as in stack.cpp
    bl fill
    ldr r0, =zero_begin
    ldr r1, =zero_end
    movs r2, #0
    bl fill

#ifdef VOLCOMP_TIGHTLY_COUPLED
    ldr r0, =dtcm_begin
    ldr r1, =dtcm_end
    bl fill
    ldr r0, =itcm_image
    ldr r1, =itcm_begin
    ldr r2, =itcm_end
copy_code:
    cmp r1, r2
    ittt lo
    ldrlo r3, [r0], #4
    strlo r3, [r1], #4
    blo copy_code
    dsb                         // the copied code is there before it is fetched
    isb
#endif

    ldr r0, =data_image
    ldr r1, =data_begin
    ldr r2, =data_end
copy_word:
    cmp r1, r2
    ittt lo
    ldrlo r3, [r0], #4
    strlo r3, [r1], #4
    blo copy_word

    bl start_board
    bl main
    bl end_of_program
    udf #0                      // it does not return

// Words of r2 from r0 up to r1.
fill:
    cmp r0, r1
    itt lo
    strlo r2, [r0], #4
    blo fill
    bx lr
    .size Reset_Handler, . - Reset_Handler

// Faults, the watchdog's NMI and unexpected interrupts: the interrupted stack may be unusable, so the report runs on
// one of its own, unless they interrupt a report.
    .macro use_fault_stack
    ldr r2, =fault_stack_top
    subs r3, r2, r0
    ldr r12, =fault_stack_bytes
    cmp r3, r12
    it hi
    movhi sp, r2
    .endm

// r0: the registers that the processor has stacked, r1: EXC_RETURN (B1.5.8).
    .macro report_handler name, report
    .section .text.\name, "ax", %progbits
    .global \name
    .type \name, %function
\name:
    tst lr, #4
    ite eq
    mrseq r0, msp
    mrsne r0, psp
    mov r1, lr
    use_fault_stack
    b \report
    .size \name, . - \name
    .endm

    report_handler MemManage_Handler, report_fault
    report_handler BusFault_Handler, report_fault
    report_handler UsageFault_Handler, report_fault
    report_handler NMI_Handler, report_watchdog
    report_handler Unexpected_Handler, report_unexpected_interrupt

// A semihosting request without a debugger arrives here, too, and is the one fault that leaves CFSR clear: it returns
// -1.
    .section .text.HardFault_Handler, "ax", %progbits
    .global HardFault_Handler
    .type HardFault_Handler, %function
HardFault_Handler:
    tst lr, #4
    ite eq
    mrseq r0, msp
    mrsne r0, psp
    mov r1, lr
    ldr r2, =0xE000ED28         // CFSR (B3.2.15); unless it is clear the stack may not be readable
    ldr r3, [r2]
    cbnz r3, 1f
    ldr r3, [r0, #24]           // stacked return address
    ldr r12, =semihosting_breakpoint
    cmp r3, r12
    bne 1f
    adds r3, r3, #2
    str r3, [r0, #24]
    mov r3, #-1
    str r3, [r0, #0]            // stacked r0
    str r3, [r2, #4]            // HFSR (B3.2.16): written ones clear
    bx lr
1:  use_fault_stack
    b report_fault
    .size HardFault_Handler, . - HardFault_Handler
