"""Small programs for the target with a known answer each: what the checks measure is right, and each kind of offence is found."""
import pathlib
import re
import subprocess
import tempfile

import budgets
import code_flow
import elf
import groups
import instructions
import link_map
import sizes
import stack_bound
import symbol_rules
import traced_tick
from documented_calls import PointerCall, VirtualCall
from failure import Failure

COMPILER = ["arm-none-eabi-g++", "-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-std=c++17", "-O2", "-w",
            "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-fno-use-cxa-atexit", "-ffunction-sections",
            "-nostartfiles", "--specs=nano.specs", "-Wl,-Ttext=0x400", "-Wl,-Tdata=0x20000000", "-Wl,-e,entry"]

# name: (bytes of stack, assembly); every one is a function of its own, `leaf` takes 48 bytes.
FRAMES = {
    "leaf": (48, "push {r4-r7, lr}\n vpush {d8-d9}\n sub sp, #12\n add sp, #12\n vpop {d8-d9}\n pop {r4-r7, pc}"),
    "calls": (56, "push {r4, lr}\n bl leaf\n pop {r4, pc}"),
    "jumps_at_its_end": (48, "push {r4, lr}\n pop {r4, lr}\n b leaf"),
    "jumps_with_a_frame": (56, "push {r4, lr}\n b leaf_without_return\n leaf_without_return: bl leaf\n pop {r4, pc}"),
    "stores_and_loads": (52, "str lr, [sp, #-4]!\n bl leaf\n ldr pc, [sp], #4"),
    "returns_on_a_condition": (56, "push {r4, lr}\n cmp r0, #0\n it eq\n popeq {r4, pc}\n bl leaf\n pop {r4, pc}"),
    "wide_frame": (4 + 2048 + 48, "push {lr}\n sub.w sp, sp, #2048\n bl leaf\n add.w sp, sp, #2048\n pop {pc}"),
    "deep_after_the_call": (100, "push {lr}\n bl leaf\n sub sp, #96\n add sp, #96\n pop {pc}"),
    "loops": (4 + 48, "push {lr}\n 1: bl leaf\n subs r0, #1\n bne 1b\n pop {pc}"),
    "tables": (64, "cmp r0, #2\n bhi 9f\n tbb [pc, r0]\n 0: .byte (1f-0b)/2, (2f-0b)/2, (9f-0b)/2, 0\n"
                   " 1: sub sp, #64\n add sp, #64\n bx lr\n 2: sub sp, #32\n add sp, #32\n 9: bx lr"),
    "tables_of_addresses": (24, "cmp r2, #1\n bhi 9f\n adr r1, 0f\n ldr.w pc, [r1, r2, lsl #2]\n .align 2\n 0: .word 1f+1, 9f+1\n"
                                " 1: sub sp, #24\n add sp, #24\n 9: bx lr"),
    "keeps_its_stack_pointer": (8, "sub sp, #8\n str.w sp, [sp, #4]\n add sp, #8\n bx lr"),
    "never_comes_back": (8, "push {r4, lr}\n bl forever\n pop {r4-r7, pc}"),
    "forever": (0, "1: b 1b"),
}

OFFENCES = {
    "recursion": ["recurses: push {lr}\n bl recurses\n pop {pc}",
                  "even: push {lr}\n bl odd\n pop {pc}\n .thumb_func\n odd: push {lr}\n bl even\n pop {pc}"],
    "calls what no list documents": ["anywhere: push {lr}\n blx r3\n pop {pc}", "anywhere: bx r3"],
    "known at run time only": ["variable: sub sp, r0\n add sp, r0\n bx lr", "variable: mov sp, r7\n bx lr"],
    "changes the stack on a condition": ["sometimes: cmp r0, #0\n it eq\n subeq sp, #8\n bx lr"],
    "is reached with": ["differs: cmp r0, #0\n beq 1f\n sub sp, #8\n 1: bx lr"],
    "jump table of unknown length": ["table: tbb [pc, r0]\n 0: .byte 1, 1\n bx lr",
                                     "table: cmp r2, #1\n ldr.w pc, [r1, r2, lsl #2]"],
    "switches the stack": ["other: msr msp, r0\n bx lr"],
    "where there is no instruction": ["off: .2byte 0xe000\n .4byte 0"],
}

VIRTUAL = """
struct Interface { virtual int small(int) = 0; virtual int large(int) = 0; };
struct One final : Interface { int small(int) override; int large(int) override; };
struct Other final : Interface { int small(int) override; int large(int) override; };
extern "C" { void take16(); void take400(); void take800(); }
int One::small(int x) { take16(); return x + 1; }      int One::large(int x) { take400(); return x + 2; }
int Other::small(int x) { take16(); return x + 3; }    int Other::large(int x) { take800(); return x + 4; }
extern const One one; extern const Other other; One one_object; Other other_object;
int ask_small(Interface& i) { return i.small(1) + 1; }
int ask_large(Interface& i) { return i.large(1) + 1; }
extern "C" void entry() { ask_small(one_object); ask_large(other_object); }
asm(".thumb\\n .syntax unified\\n .macro take name, bytes\\n .global \\\\name\\n .type \\\\name, %function\\n .thumb_func\\n"
    "\\\\name: sub sp, #\\\\bytes\\n add sp, #\\\\bytes\\n bx lr\\n .size \\\\name, .-\\\\name\\n .endm\\n"
    "take take16, 16\\n take take400, 400\\n .global take800\\n .type take800, %function\\n .thumb_func\\n"
    "take800: sub.w sp, sp, #800\\n add.w sp, sp, #800\\n bx lr\\n .size take800, .-take800\\n");
"""


class SelfTest:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.judged = 0

    def image(self, source, suffix, *flags):
        self.judged += 1
        path = self.folder / f"{self.judged}.{suffix}"
        path.write_text(source)
        out = path.with_suffix(".elf")
        run = subprocess.run([*COMPILER, *flags, str(path), "-o", str(out)], capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise Failure(f"self-test: a small program does not build: {run.stderr}")
        return elf.Image(out)

    def assembled(self, functions):
        text = ".syntax unified\n.thumb\n.cpu cortex-m4\n.fpu fpv4-sp-d16\n.global entry\n"
        for body in functions:
            name = re.match(r"(\w+):", body).group(1)
            text += f".type {name}, %function\n.thumb_func\n{body}\n.size {name}, .-{name}\n.align 2\n"
        return self.image(text + ".thumb_func\nentry: bx lr\n", "s", "-nostdlib")

    @staticmethod
    def expect(condition, what):
        if not condition:
            raise Failure(f"self-test: {what}.")

    def frames(self):
        image = self.assembled([f"{name}: {body}" for name, (_, body) in FRAMES.items()])
        bounds = stack_bound.StackBound(code_flow.CodeFlow(image), ())
        for name, (wanted, _) in FRAMES.items():
            bound = bounds.of(image.symbol(name).address)
            self.expect(not bound.problems, f"{name} was refused: {bound.problems}")
            self.expect(bound.bytes == wanted, f"{name} takes {wanted} bytes of stack, not {bound.bytes}")

    def offences(self):
        for sentence, programs in OFFENCES.items():
            for program in programs:
                image = self.assembled([program])
                bound = stack_bound.StackBound(code_flow.CodeFlow(image), ()).of(
                    image.symbol(re.match(r"\w+", program).group(0)).address)
                self.expect(any(sentence in p for p in bound.problems),
                            f'"{sentence}" was not found in {program!r}, but {bound.problems}')

    def virtual_calls(self):
        image = self.image(VIRTUAL, "cpp", "-fno-inline", "-nostdlib")
        flow = code_flow.CodeFlow(image)
        entry = image.symbol("entry").address
        known = VirtualCall(r"ask_\w+\(.*", "One|Other", "of the self-test")
        bounds = stack_bound.StackBound(flow, (known,))
        small, large = (bounds.of(image.find(re.compile(rf"ask_{size}\(.*"))[0].address) for size in ("small", "large"))
        self.expect(not small.problems and not large.problems, f"documented calls were refused: {small.problems}")
        self.expect(large.bytes - small.bytes == 800 - 16, "a virtual call leads to the function of its slot, the deepest of all "
                    f"classes: {large.bytes} and {small.bytes} bytes")
        elsewhere = VirtualCall(r"nobody", "One|Other", "of the self-test")
        self.expect(stack_bound.StackBound(flow, (elsewhere,)).of(entry).problems, "a call was excused by another one's entry")
        back = PointerCall(r"ask_small\(.*", r"entry", "of the self-test")
        problems = stack_bound.StackBound(flow, (known, back)).of(entry).problems
        self.expect(any("recursion" in p for p in problems), "recursion through a documented pointer was not found")

    def dynamic_frames(self):
        for body in ("__builtin_alloca(n)", "({ char a[n]; use(a); a[0]; })"):
            image = self.image("extern \"C\" void use(const void* p) { asm volatile(\"\" :: \"r\"(p) : \"memory\"); }\n"
                               f"extern \"C\" void entry(int n) {{ use((const void*)({body})); }}", "cpp", "-nostdlib")
            problems = stack_bound.StackBound(code_flow.CodeFlow(image), ()).of(image.symbol("entry").address).problems
            self.expect(any("run time only" in p for p in problems), f"the stack of variable size of {body} was not found")

    def tick(self):
        for wanted, body in {"": "long long f(long long a, long long b) { return a / b; }",
                             "in software": "double f(double a, double b) { return a * b + 1.0; }",
                             "of a library": "#include <cmath>\nfloat f(float a) { return std::sin(a); }"}.items():
            head, function = body.split("\n") if "\n" in body else ("", body)
            image = self.image(f"{head}\nnamespace volcomp {{ [[gnu::used, gnu::noinline]] {function} }}\n"
                               "extern \"C\" void entry() {}", "cpp", "-lm")
            bound = stack_bound.StackBound(code_flow.CodeFlow(image), ()).of(image.find(re.compile(r"volcomp::f\(.*"))[0].address)
            found = symbol_rules.foreign_in_tick(image, bound.symbols)
            self.expect(any(wanted in s for s in found) if wanted else not found, f"the tick \"{body}\" was judged wrongly: {found}")

    def sizes(self):
        image = self.image("[[gnu::used]] int zero[100]; [[gnu::used]] int set[10] = {1}; extern \"C\" void entry() {}",
                           "cpp", "-nostdlib")
        self.expect(sizes.measure(image).ram == 440, f"440 bytes of variables were measured as {sizes.measure(image).ram}")

    def budgets(self):
        for measured, wanted in ((400, True), (401, False)):
            found = budgets.Check("a figure", measured, 400).kept()
            self.expect(found == wanted, f"{measured} of 400 was judged wrongly")

    def groups(self):
        def piece(section, library, source):
            return link_map.Piece(section, 0, 4, library, source)

        unit = "_ZN7volcomp11CompensatorINS_13LoadedMachineILj5ELj0EEELj128ENS_13OffsetLimiterILb1EEEE"
        for wanted, given in {"tick": piece(f".text.{unit}4tickERKNS_9TickInputE", "comp", "instances.cpp"),
                              "compensator, background": piece(f".text.unlikely.{unit}7restartERK", "comp", "instances.cpp"),
                              "node": piece(".text._ZN7volcomp4node4Node4tickERKNS_11CompensatorE", "node", "node.cpp"),
                              "texts": piece(".rodata.str1.1", "node", "node.cpp"),
                              "board": piece(".text.Reset_Handler", "", "startup.S"),
                              "libgcc and libc": piece(".text.memcpy", "", "lib_a-memcpy")}.items():
            found = groups.group_of(given)
            self.expect(found == wanted, f"{given.section} of {given.source} belongs to \"{wanted}\", not to \"{found}\"")

    def traced(self):
        """Memory that an instruction touches, by the registers before it; a chain of dependent additions."""
        registers = {n: 0x2000_0000 + 0x100 * n for n in range(16)}
        for wanted, mnemonic, operands in (((0x2000_0104, 4), "ldr", "r0, [r1, #4]"), ((0x2000_0100, 8), "ldrd", "r0, r2, [r1], #8"),
                                           ((0x2000_0200, 48), "vldmia", "r2, {s0-s11}"), ((0x2000_0CF4, 12), "push", "{r4, r5, lr}"),
                                           ((0x2000_0102, 2), "ldrh.w", "r0, [r1, #2]"), ((0x104, 4), "ldr", "r0, [pc, #0]"),
                                           (None, "add", "r0, r1")):
            found = traced_tick.span_of(instructions.Instruction(0x100, mnemonic, operands), registers)
            self.expect(found == wanted, f"{mnemonic} {operands} touches {wanted}, not {found}")
        for wanted, encoded in ((1.0, 0x70), (2.0, 0x00), (-0.5, 0xE0), (31.0, 0x3F)):
            self.expect(traced_tick.constant(encoded) == wanted, f"a vmov of #{encoded} is {wanted}")
        one, many = (traced_tick.cycles([instructions.Instruction(0, "add", "r0, r0, r1")] * n) for n in (20, 40))
        self.expect(many - one == 20, f"20 additions more, each waiting for the last, take {many - one} cycles")

    def run(self):
        for check in (self.budgets, self.groups, self.traced, self.frames, self.offences, self.virtual_calls, self.dynamic_frames, self.tick, self.sizes):
            check()
        print(f"self-test: {self.judged} small programs judged rightly")


def main():
    with tempfile.TemporaryDirectory() as folder:
        SelfTest(folder).run()
