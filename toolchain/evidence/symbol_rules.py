"""What may not be in an image, and what the tick may use beside the code of this project."""
import re

# An image that contains or calls one of these can take memory, throw, ask for a type at run time, or run code before main.
FORBIDDEN = {
    "heap": r"_sbrk(_r)?|(__libc_|_*)?(malloc|calloc|realloc|reallocarray|free|cfree|memalign|aligned_alloc|posix_memalign|valloc|pvalloc"
            r"|strdup|strndup)(_r)?|_Zn[wa].*|_Zd[la].*",
    "exceptions": r"__cxa_(allocate_exception|free_exception|throw|rethrow|begin_catch|end_catch|end_cleanup|init_primary_exception|bad_cast"
                  r"|bad_typeid|call_unexpected|get_exception_ptr|throw_bad_array_new_length)|_Unwind_.*|__gxx_personality.*"
                  r"|__aeabi_unwind_.*|_ZSt[0-9]+__throw_.*|_ZSt9terminatev",
    "types": r"_ZT[IS].*|__dynamic_cast",
    "guards": r"__cxa_guard_.*",
    "destructors": r"__cxa_atexit|__cxa_thread_atexit(_impl)?|__aeabi_atexit|atexit|at_quick_exit",
    "initializers": r"_GLOBAL__(sub_)?[ID]_.*|_Z41__static_initialization_and_destruction_0.*",
    "printing": r"v?(f|s|sn)?(i)?printf(_r)?|_v?fi?printf_r|puts|fwrite",
}

# Mathematics of the C library.
LIBM = re.compile(
    r"(__)?(a?cosh?|a?sinh?|a?tanh?|atan2|sincos|sqrt|cbrt|hypot|pow|powi|pow10|exp|exp2|exp10|expm1|log|log2|log10|log1p|logb|ilogb"
    r"|ldexp|frexp|modf|scalbl?n|erfc?|[lt]gamma|gamma|lgamma_r|j[01n]|y[01n]|floor|ceil|trunc|round|roundeven|l?lround|rint|l?lrint"
    r"|nearbyint|fabs|fmod|remainder|remquo|drem|copysign|nan|nextafter|nexttoward|nextup|nextdown|fdim|fmax|fmin|fma|significand"
    r"|fe(clear|get|raise|set|test)except(flag)?|fe[gs]etround|fe[gs]etenv|feholdexcept|feupdateenv)[fl]?(_finite)?"
    r"|__(fpclassify|signbit|isinf|isnan|finite|issignaling)[fl]?")

# Code of the compiler's library that the tick may use: integers of 64 bits. Run-time ABI for the Arm Architecture
# (IHI 0043), 4.2.
INTEGER_HELPERS = re.compile(
    r"__aeabi_(u?ldivmod|u?idiv(mod)?|lmul|l[ls]sl|llsr|lasr|u?lcmp|[iul]+div0|ldiv0|idiv0)|__udivmoddi4|__divmoddi4"
    r"|__aeabi_u?l(div)?mod|__clz[sd]i2|__popcount[sd]i2|__muldi3|__ashldi3|__ashrdi3|__lshrdi3")
MEMORY_HELPERS = re.compile(r"mem(cpy|set|move)|__aeabi_mem(cpy|set|clr|move)[48]?")

# By the symbol: the plain name of a function template begins with its return type.
OUR_CODE = re.compile(r"_ZZ?NK?7volcomp")

SOFT_DOUBLE = re.compile(
    r"__aeabi_(c?d\w+|\w+2d|i2d|ui2d|f2d|l2d|ul2d|h2d)|__(add|sub|mul|div|neg|extend|trunc|float|fix|fixuns|floatun|cmp|eq|ne|"
    r"lt|le|gt|ge|unord)\w*df\w*|__(fix|fixuns)df\w+")


def forbidden_in(image):
    """Sentences, one per symbol that the image contains or calls and must not."""
    rules = {kind: re.compile(pattern) for kind, pattern in FORBIDDEN.items()}
    return sorted({f"{image.path.name}: {kind}: {image.plain(symbol)}" for symbol in image.symbols for kind, pattern in rules.items()
                   if pattern.fullmatch(symbol.name.partition("@")[0])})


def foreign_in_tick(image, names):
    """Sentences, one per function of the tick's call graph that is neither ours nor an allowed helper."""
    sentences = []
    for name in sorted(names):
        plain = image.plain(image.symbol(name))
        if OUR_CODE.match(name) or INTEGER_HELPERS.fullmatch(name) or MEMORY_HELPERS.fullmatch(name):
            continue
        what = "double-precision arithmetic in software" if SOFT_DOUBLE.fullmatch(name) else "of a library"
        sentences.append(f"The tick reaches {plain} ({what}).")
    return sentences
