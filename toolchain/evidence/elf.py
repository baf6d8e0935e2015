"""Sections, symbols and bytes of an ELF file, as pyelftools reads them.

Thumb bit of function symbols: ELF for the Arm Architecture (IHI 0044), 5.5.3.
"""
import bisect
import dataclasses
import subprocess

from elftools.common.exceptions import ELFError
from elftools.elf.constants import SH_FLAGS
from elftools.elf.elffile import ELFFile

from failure import Failure


@dataclasses.dataclass(frozen=True)
class Section:
    name: str
    address: int
    size: int
    writable: bool
    contents: bytes  # none where the file has none


@dataclasses.dataclass(frozen=True)
class Symbol:
    name: str
    address: int
    size: int
    kind: str
    defined: bool

    def is_function(self):
        return self.kind == "STT_FUNC" and self.defined


class Image:
    def __init__(self, path):
        self.path = path
        try:
            with path.open("rb") as stream:
                self._read(ELFFile(stream))
        except OSError as error:
            raise Failure(f"{path} cannot be read: {error.strerror}.") from error
        except ELFError as error:
            raise Failure(f"{path} is no ELF file: {error}.") from error
        self._by_address = sorted((s for s in self.symbols if s.is_function()), key=lambda s: (s.address, -s.size))
        self._addresses = [s.address for s in self._by_address]
        self._plain = {}

    def _read(self, file):
        self.machine = file["e_machine"]
        self.segments = [(s["p_paddr"], s["p_filesz"]) for s in file.iter_segments("PT_LOAD") if s["p_filesz"] > 0]
        self.sections = [Section(s.name, s["sh_addr"], s["sh_size"], bool(s["sh_flags"] & SH_FLAGS.SHF_WRITE),
                                 b"" if s["sh_type"] == "SHT_NOBITS" else s.data())
                         for s in file.iter_sections() if s["sh_flags"] & SH_FLAGS.SHF_ALLOC and s["sh_size"] > 0]
        table = file.get_section_by_name(".symtab")
        if table is None:
            raise Failure(f"{self.path} has no symbols.")
        self.symbols = [self._symbol(s) for s in table.iter_symbols()]

    def _symbol(self, symbol):
        kind, address = symbol["st_info"]["type"], symbol["st_value"]
        if kind == "STT_FUNC" and self.machine == "EM_ARM":
            address &= ~1
        return Symbol(symbol.name, address, symbol["st_size"], kind, symbol["st_shndx"] != "SHN_UNDEF")

    def read(self, address, size):
        """Bytes the image puts at an address."""
        for s in self.sections:
            if s.address <= address and address + size <= s.address + len(s.contents):
                return s.contents[address - s.address:address - s.address + size]
        raise Failure(f"{self.path.name} has nothing at 0x{address:x}.")

    def function_at(self, address):
        """The function symbol whose code contains the address, or None."""
        i = bisect.bisect_right(self._addresses, address)
        while i > 0:
            i -= 1
            symbol = self._by_address[i]
            if symbol.address <= address < symbol.address + max(symbol.size, 1):
                return symbol
            if symbol.address + 0x10000 < address:
                break
        return None

    def symbol(self, name):
        return next((s for s in self.symbols if s.name == name), None)

    def plain(self, symbol):
        """Demangled name."""
        if not self._plain:
            names = [s.name for s in self.symbols]
            run = subprocess.run(["c++filt"], input="\n".join(names), capture_output=True, text=True, check=True)
            self._plain = dict(zip(names, run.stdout.split("\n")))
        return self._plain[symbol.name]

    def find(self, pattern):
        """Functions whose demangled name matches the compiled pattern as a whole, one per address."""
        found = {s.address: s for s in self.symbols if s.is_function() and pattern.fullmatch(self.plain(s))}
        return [found[a] for a in sorted(found)]
