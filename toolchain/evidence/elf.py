"""Reads an ELF file of 32 or 64 bits, little-endian: sections, symbols, bytes.

Format: System V ABI, "Object Files"; Thumb bit of function symbols: ELF for the Arm Architecture (IHI 0044), 5.5.3.
"""
import bisect
import dataclasses
import struct
import subprocess

from failure import Failure

ARM = 40
SHF_WRITE, SHF_ALLOC, SHF_EXECINSTR = 1, 2, 4
SHT_SYMTAB, SHT_NOBITS = 2, 8
PT_LOAD = 1
STT_OBJECT, STT_FUNC = 1, 2


@dataclasses.dataclass(frozen=True)
class Section:
    name: str
    kind: int
    flags: int
    address: int
    offset: int
    size: int
    link: int

    def loaded(self):
        return bool(self.flags & SHF_ALLOC) and self.size > 0


@dataclasses.dataclass(frozen=True)
class Symbol:
    name: str
    address: int
    size: int
    kind: int
    section: int

    def is_function(self):
        return self.kind == STT_FUNC


class Image:
    def __init__(self, path):
        self.path = path
        try:
            self.bytes = path.read_bytes()
        except OSError as error:
            raise Failure(f"{path} cannot be read: {error.strerror}.") from error
        if self.bytes[:4] != b"\x7fELF" or self.bytes[5] != 1:
            raise Failure(f"{path} is no little-endian ELF file.")
        self.wide = self.bytes[4] == 2
        self.machine = struct.unpack_from("<H", self.bytes, 18)[0]
        self.sections = self._read_sections()
        self.segments = self._read_segments()
        self.symbols = self._read_symbols()
        self._by_address = sorted((s for s in self.symbols if s.is_function()), key=lambda s: (s.address, -s.size))
        self._addresses = [s.address for s in self._by_address]
        self._plain = {}

    def _read_sections(self):
        layout, start, where = ("<IIQQQQIIQQ", 40, 58) if self.wide else ("<IIIIIIIIII", 32, 46)
        table = struct.unpack_from("<Q" if self.wide else "<I", self.bytes, start)[0]
        entry, count, names = struct.unpack_from("<HHH", self.bytes, where)
        raw = [struct.unpack_from(layout, self.bytes, table + entry * i) for i in range(count)]
        strings = raw[names][4]
        return [Section(self._text(strings + r[0]), r[1], r[2], r[3], r[4], r[5], r[6]) for r in raw]

    def _read_segments(self):
        """What is loaded: (load address, bytes in the file)."""
        start = struct.unpack_from("<Q" if self.wide else "<I", self.bytes, 32 if self.wide else 28)[0]
        entry, count = struct.unpack_from("<HH", self.bytes, 54 if self.wide else 42)
        segments = []
        for at in range(start, start + entry * count, entry):
            if self.wide:
                kind, _, _, _, load, size = struct.unpack_from("<IIQQQQ", self.bytes, at)
            else:
                kind, _, _, load, size = struct.unpack_from("<IIIII", self.bytes, at)
            if kind == PT_LOAD and size > 0:
                segments.append((load, size))
        return segments

    def _text(self, offset):
        return self.bytes[offset:self.bytes.index(0, offset)].decode()

    def _read_symbols(self):
        table = next((s for s in self.sections if s.kind == SHT_SYMTAB), None)
        if table is None:
            raise Failure(f"{self.path} has no symbols.")
        strings = self.sections[table.link].offset
        symbols = []
        for at in range(table.offset, table.offset + table.size, 24 if self.wide else 16):
            if self.wide:
                name, info, _, section, value, size = struct.unpack_from("<IBBHQQ", self.bytes, at)
            else:
                name, value, size, info, _, section = struct.unpack_from("<IIIBBH", self.bytes, at)
            kind = info & 0xF
            if kind == STT_FUNC and self.machine == ARM:
                value &= ~1
            symbols.append(Symbol(self._text(strings + name), value, size, kind, section))
        return symbols

    def read(self, address, size):
        """Bytes the image puts at an address."""
        for s in self.sections:
            if s.loaded() and s.kind != SHT_NOBITS and s.address <= address and address + size <= s.address + s.size:
                start = s.offset + address - s.address
                return self.bytes[start:start + size]
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
