// uint64_t registers_lost(const volatile uint32_t* ticks): fills every register that an interrupt must not change, waits
// until *ticks changes, and returns how many of them are no longer what they were.
//
// x0 ticks, w1 their number before, w2 now, x3 what is compared with; the others and the whole FPU hold their number.
    .section .text.registers_lost, "ax", %progbits
    .global registers_lost
    .type registers_lost, %function

    .macro for_each_general body
    .irp n, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30
    \body \n
    .endr
    .endm
    .macro for_each_vector body
    .irp n, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31
    \body \n
    .endr
    .endm
    .macro set_general n
    mov x\n, #\n
    .endm
    .macro set_vector n
    mov w3, #(\n + 1000)
    dup v\n\().4s, w3
    .endm
    .macro check_general n
    cmp x\n, #\n
    cinc x2, x2, ne
    .endm
    .macro check_vector n
    mov x3, #(\n + 1000)
    orr x3, x3, x3, lsl #32
    mov x4, v\n\().d[0]
    cmp x3, x4
    cinc x2, x2, ne
    mov x4, v\n\().d[1]
    cmp x3, x4
    cinc x2, x2, ne
    .endm

registers_lost:
    stp x29, x30, [sp, #-160]!
    stp x19, x20, [sp, #16]
    stp x21, x22, [sp, #32]
    stp x23, x24, [sp, #48]
    stp x25, x26, [sp, #64]
    stp x27, x28, [sp, #80]
    stp d8, d9, [sp, #96]
    stp d10, d11, [sp, #112]
    stp d12, d13, [sp, #128]
    stp d14, d15, [sp, #144]
    for_each_vector set_vector
    for_each_general set_general
    ldr w1, [x0]
1:  ldr w2, [x0]
    cmp w2, w1
    b.eq 1b
    mov x2, #0
    for_each_general check_general
    for_each_vector check_vector
    mov x0, x2
    ldp d14, d15, [sp, #144]
    ldp d12, d13, [sp, #128]
    ldp d10, d11, [sp, #112]
    ldp d8, d9, [sp, #96]
    ldp x27, x28, [sp, #80]
    ldp x25, x26, [sp, #64]
    ldp x23, x24, [sp, #48]
    ldp x21, x22, [sp, #32]
    ldp x19, x20, [sp, #16]
    ldp x29, x30, [sp], #160
    ret
    .size registers_lost, . - registers_lost
