#pragma once
// The tick is one straight run of instructions: its small functions are inlined whatever the
// optimiser thinks, its bounded loops unrolled.

#define VOLCOMP_INLINE [[gnu::always_inline]] inline
#define VOLCOMP_INLINE_LAMBDA __attribute__((always_inline))

#if defined(__clang__)
#define VOLCOMP_UNROLL _Pragma("unroll")
#else
#define VOLCOMP_UNROLL _Pragma("GCC unroll 8")
#endif

// The condition of an exception: its branch is moved out of the straight run.
#define VOLCOMP_RARELY(condition) __builtin_expect(static_cast<bool>(condition), false)
