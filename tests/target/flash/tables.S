// Tables of the machine of the servo example with few knots, so that they fit the node of every board.
    .section .rodata.tables, "a", %progbits
    .global tables_begin
    .global tables_end
tables_begin:
    .incbin "tests/data/corpus/image/xyfz.bin"
tables_end:
