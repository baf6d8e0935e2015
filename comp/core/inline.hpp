#pragma once
// The tick is one straight run of instructions: its small functions are inlined regardless of the
// optimiser, its bounded loops unrolled, but for those of VOLCOMP_LOOP.

#define VOLCOMP_INLINE [[gnu::always_inline]] inline
#define VOLCOMP_INLINE_LAMBDA __attribute__((always_inline))

#if defined(__clang__)
#define VOLCOMP_UNROLL _Pragma("unroll")
#define VOLCOMP_LOOP _Pragma("nounroll")
#else
#define VOLCOMP_UNROLL _Pragma("GCC unroll 8")
#define VOLCOMP_LOOP _Pragma("GCC unroll 1")
#endif

// The condition of an exception: its branch is moved out of the straight run.
#define VOLCOMP_UNLIKELY(condition) __builtin_expect(static_cast<bool>(condition), false)

// Keeps a pointer in a register, where GCC would form an address of an atomic access anew.
#define VOLCOMP_KEEP_IN_REGISTER(pointer) __asm("" : "+r"(pointer))
