    .syntax unified
    .section .vectors, "a"
    .word __stack
    .word reset + 1
    .rept 14
    .word stop + 1
    .endr

    .section .text.reset, "ax"
    .thumb_func
    .global reset
reset:
    @ Coprocessors 10 and 11: a processor without them ignores it.
    ldr r0, =0xe000ed88
    ldr r1, =0x00f00000
    str r1, [r0]
    dsb
    isb
    ldr r0, =__data
    ldr r1, =__data_end
    ldr r2, =__data_source
1:  cmp r0, r1
    bhs 2f
    ldr r3, [r2]
    str r3, [r0]
    adds r0, r0, #4
    adds r2, r2, #4
    b 1b
2:  ldr r0, =__bss
    ldr r1, =__bss_end
    movs r2, #0
3:  cmp r0, r1
    bhs 4f
    str r2, [r0]
    adds r0, r0, #4
    b 3b
4:  bl run

    @ A fault: asks the emulator to leave.
    .thumb_func
stop:
    movs r0, #0x18
    ldr r1, =0x20023
    bkpt 0xab
    b stop
    .ltorg
