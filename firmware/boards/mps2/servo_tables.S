// The tables of the servo example in flash: the simulated machine of host_sim/machines/xyfz.toml, measured without
// noise by `volcomp run xyfz --draws 0 --report DIR` and built by
// `volcomp build-tables --machine host_sim/machines/xyfz.toml --runs DIR/campaign/noise_free/runs_?.csv`.
    .section .rodata.servo_tables, "a", %progbits
    .global servo_tables_begin
    .global servo_tables_end
servo_tables_begin:
    .incbin "firmware/embed/cpp/xyfz.vct"
servo_tables_end:
