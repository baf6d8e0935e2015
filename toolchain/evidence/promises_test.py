"""Planted offences, linked for each target as libvolcomp_comp.a into a small whole image: each is found, and nothing in a clean one."""
import itertools
import pathlib
import re
import subprocess
import tempfile

import promises
from failure import Failure

CORTEX_M = ["arm-none-eabi-g++", "-mthumb", "-mfloat-abi=hard", "-ffunction-sections", "-Wl,-Ttext=0x400", "-Wl,-Tdata=0x20000000"]
# The relocations keep the names of what is called and missing.
BARE = ["-nostdlib", "-static", "-Wl,--unresolved-symbols=ignore-all", "-Wl,--emit-relocs", "-Wl,--defsym=__dso_handle=0"]
COMPILERS = {"m7": [*CORTEX_M, "-mcpu=cortex-m7", "-mfpu=fpv5-d16", *BARE],
             "m4": [*CORTEX_M, "-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", *BARE],
             "a53": ["aarch64-linux-gnu-g++", "-mcpu=cortex-a53", "-fno-pie", "-no-pie", "-ffunction-sections", *BARE],
             "host": ["g++", "-Wl,--unresolved-symbols=ignore-all"]}
RULES = ["-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics"]  # volcomp_target_rules
MATHEMATICS = [f"{name}{kind}" for name, kind in itertools.product(
    "sin cos tan asin atan2 sincos sinh sqrt cbrt hypot pow exp log floor ceil trunc round lround llround rint lrint llrint nearbyint "
    "fmod remainder modf frexp ldexp fma fmin".split(), ("", "f", "l"))]

# source: (what it contains, what has to be found). What is named interrupt_* runs in the interrupt.
PLANTED = {
    "heap.cpp": ("""#include <cstdlib>
        void* f1() { return malloc(1); }  void* f2() { return calloc(1, 1); }  void* f3(void* p) { return realloc(p, 2); }
        void f4(void* p) { free(p); }  void* f5() { return aligned_alloc(16, 16); }
        extern "C" int posix_memalign(void**, std::size_t, std::size_t);  void f6(void** p) { posix_memalign(p, 16, 16); }
        int* f7() { return new int; }  int* f8(unsigned n) { return new int[n]; }
        void f9(int* p) { delete p; }  void f10(int* p) { delete[] p; }
        struct Base { virtual ~Base(); };  Base::~Base() = default;""",
                 [*(f"heap: {name}" for name in "malloc calloc realloc free aligned_alloc posix_memalign".split()),
                  *(rf"heap: operator {name}\(" for name in ("new", r"new\[\]", "delete", r"delete\[\]"))]),
    "own_new.cpp": ("#include <new>\nalignas(16) static char pool[64]; void* operator new(std::size_t, std::align_val_t) { return pool; }",
                    [r"heap: operator new\(unsigned \w+, std::align_val_t\)"]),
    "throwing.cpp": ("void thrower() { throw 1; }", ["exceptions: __cxa_throw", "exceptions: __cxa_allocate_exception"]),
    "catching.cpp": ("void thrower(); int catcher() { try { thrower(); } catch (...) { return 1; } return 0; }",
                     ["exceptions: __cxa_begin_catch", "exceptions: __cxa_end_catch"]),
    "unwinding.cpp": ("struct Unwound { ~Unwound(); }; void thrower(); void unwinder() { Unwound a; thrower(); }",
                      ["exceptions: (_Unwind_Resume|__cxa_end_cleanup)", "exceptions: __gxx_personality_v0"]),
    "library_throw.cpp": ("#include <array>\nint at(const std::array<int, 3>& a, unsigned i) { return a.at(i); }",
                          ["exceptions: std::__throw_out_of_range_fmt"]),
    "types.cpp": ("struct Typed { virtual void f(); }; void Typed::f() {} struct More : Typed { void f() override; };\n"
                  "More* as_more(Typed* t) { return dynamic_cast<More*>(t); }", ["types: typeinfo for Typed", "types: __dynamic_cast"]),
    "local_static.cpp": ("int g(); int guarded() { static const int i = g(); return i; }", ["guards: __cxa_guard_acquire"]),
    "global_object.cpp": ("struct Global { ~Global(); }; Global global;", ["destructors: (__cxa_atexit|__aeabi_atexit)"]),
    "global_start.cpp": ("int g(); const int started = g(); const int& start() { return started; }",
                         ["initializers: _GLOBAL__sub_I_", "initializers: .init_array\\S* of global_start.cpp"]),
    "attribute.cpp": ("void g(); [[gnu::constructor]] void constructor() { g(); }", ["initializers: .init_array\\S* of attribute.cpp"]),
    "printing.cpp": ('#include <cstdio>\nvoid print(int i) { printf("%d", i); }', ["printing: printf"]),
    "initialized.cpp": ("int counter = 3; int count() { return ++counter; }", ["globals: .data\\S* of initialized.cpp"]),
    "zeroed.cpp": ("static int counter; int count_zeroed() { return ++counter; }", ["globals: .bss\\S* of zeroed.cpp"]),
    "thread_local.cpp": ("thread_local int counted = 1; int count_mine() { return ++counted; }", ["globals: .t?data\\S* of thread_local.cpp"]),
    "recursion.cpp": ("int direct(int n) { return n < 2 ? n : direct(n - 1) * direct(n - 2); }\n"
                      "int other(int); [[gnu::noinline]] int mutual(int n) { return n ? other(n - 1) + 1 : 0; }\n"
                      "[[gnu::noinline]] int other(int n) { return n ? mutual(n / 2) * 3 : 1; }",
                      ["recursion: direct\\(int\\)", "recursion: (mutual|other)\\(int\\) is called by"]),
    "across_one.cpp": ("int across_two(int); int across_one(int n) { return n ? across_two(n - 1) : 0; }", []),
    "across_two.cpp": ("int across_one(int); int across_two(int n) { return n ? across_one(n / 2) : 0; }",
                       ["recursion: across_(one|two)\\(int\\) is called by"]),
    "alloca.cpp": ("void g(char*); void takes(int n) { g(static_cast<char*>(__builtin_alloca(n))); }", ["stack of variable size: takes"]),
    "array.cpp": ("void g(char*); void arrays(int n) { char a[n]; g(a); }", ["stack of variable size: arrays"]),
    "interrupt_sine.cpp": ("#include <cmath>\nfloat interrupt_sine(float x) { return std::sin(x); }",
                           ["mathematics: sinf is called by interrupt_sine"]),
    "interrupt_all.cpp": ("".join(f'extern "C" void {f}(); void all_{f}() {{ {f}(); }}\n' for f in MATHEMATICS),
                          [f"mathematics: {f} is called by all_{f}\\(\\)" for f in MATHEMATICS]),
    "interrupt_behind.cpp": ("double elsewhere(double); double interrupt_behind(double x) { return elsewhere(x) + 1.0; }",
                             ["mathematics: tanh is called by elsewhere"]),
    "elsewhere.cpp": ("#include <cmath>\n[[gnu::noinline]] double elsewhere(double x) { return std::tanh(x); }", []),
}
OF_LANGUAGE = {"throwing.cpp", "catching.cpp", "unwinding.cpp", "types.cpp", "local_static.cpp"}  # compiled without RULES
CLEAN = {
    "plain.cpp": """struct Base { virtual int f() const = 0; };  struct Derived final : Base { int f() const override { return 1; } };
        extern const Derived derived;  const Derived derived{};
        extern const char* const names[];  const char* const names[] = {"free", "sin"};
        int free_nodes(const Base& b) { return b.f() + derived.f(); }
        int f(int n) { return 2 * n; }  int g(int n) { return f(n) + f(n + 1); }
        void fill(char*);  int large() { char a[20000]; fill(a); return a[0]; }""",
    "mathematics.cpp": "#include <cmath>\ndouble sine(double x) { return std::sin(x); }",
    "same_one.cpp": "static int same(int n) { return n; } int one(int n) { return same(n); }",
    "same_two.cpp": "int one(int n); [[gnu::noinline]] static int same(int n) { return one(n); } int two(int n) { return same(n); }",
    "interrupt_plain.cpp": "double spectral(double); double twice(double x) { return spectral(2.0 * x); }",
    "spectral_line.cpp": "#include <cmath>\ndouble spectral(double x) { return std::sin(x); }",
}


def run(folder, *command):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Failure(f"self-test: a small program does not build: {' '.join(command)}\n{done.stderr}")


def whole_image(folder, compiler, sources):
    """Links the sources whole, beside empty functions in the place of the C library's mathematics, each with a second name."""
    stubs = [] if compiler[0] == "g++" else ["_start", "tanh", *MATHEMATICS]
    program, archive, out = folder / "main.cc", folder / "libvolcomp_comp.a", folder / "whole.elf"
    program.write_text("".join(f'extern "C" void {f}() {{}} extern "C" [[gnu::alias("{f}")]] void {f}_also();\n' for f in stubs) +
                       "int main() { return 0; }\n")
    for name, text in sources.items():
        (folder / name).write_text(text)
    for rules, names in (([], sorted(OF_LANGUAGE & sources.keys())), (RULES, sorted(sources.keys() - OF_LANGUAGE))):
        if names:
            run(folder, *compiler, "-std=c++17", "-O2", "-w", *rules, "-c", *names)
    for name in sources:
        (folder / name).with_suffix(".o").rename(folder / f"{name}.o")
    run(folder, "ar", "rc", archive.name, *(f"{name}.o" for name in sources))
    run(folder, *compiler, "-w", "-fno-builtin", program.name, "-Wl,--whole-archive", archive.name, "-Wl,--no-whole-archive",
        "-Wl,-Map=whole.map", "-o", out.name)
    return promises.Promises(out, {name for name in sources if name.startswith("interrupt_")})


def whole_offences(compiler, sources):
    with tempfile.TemporaryDirectory() as folder:
        image = whole_image(pathlib.Path(folder), compiler, sources)
        for libraries, interrupt in (({"comp", "absent"}, set()), ({"comp"}, {"absent.cpp"})):
            try:
                promises.Promises(image.image.path, interrupt).require(libraries)
            except Failure:
                continue
            raise Failure(f"self-test: {libraries | interrupt} was not missed.")
        return image.offences()


def main():
    expected = [sentence for _, sentences in PLANTED.values() for sentence in sentences]
    for target, compiler in COMPILERS.items():
        found = whole_offences(compiler, {name: text for name, (text, _) in PLANTED.items()})
        for sentence in expected:
            if not any(re.search(sentence, offence) for offence in found):
                raise Failure(f'self-test: {target}: "{sentence}" was not found, but\n' + "\n".join(found))
        found = whole_offences(compiler, CLEAN)
        if found:
            raise Failure(f"self-test: {target}: a clean program was refused: {found}")
        print(f"self-test: {target}: {len(expected)} planted offences found, none in {len(CLEAN)} clean sources")
