"""Flash and RAM of an image, from its headers."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Sizes:
    flash: int  # bytes from the first to the last that has to be programmed: code, constants, initial values, gaps
    ram: int    # bytes: variables, stacks, guard
    stack: int  # bytes of them: the stack of main and interrupts


def measure(image):
    first = min(load for load, _ in image.segments)
    flash = max(load + size for load, size in image.segments) - first
    ram = sum(s.size for s in image.sections if s.writable)
    stack = next((s.size for s in image.sections if s.name == ".stack"), 0)
    return Sizes(flash, ram, stack)
