"""What the linker put where, from the map of an image: which object each piece of code and data comes from."""
import bisect
import dataclasses
import re

from failure import Failure

PIECE = re.compile(r"^ (\.[\w.$:]+|COMMON)\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S+)$", re.M)


@dataclasses.dataclass(frozen=True)
class Piece:
    section: str
    address: int
    size: int
    library: str  # its name without "libvolcomp_", empty for another's
    source: str   # file name of the source, as far as the name of the object tells


def _piece(section, address, size, path):
    library = re.search(r"libvolcomp_(\w+)\.a\(", path)
    source = re.search(r"([^/(]+?)\.o(bj)?\)?$", path)
    return Piece(section, int(address, 16), int(size, 16), library[1] if library else "", source[1] if source else "")


class LinkMap:
    def __init__(self, path):
        try:
            text = path.read_text()
        except OSError as error:
            raise Failure(f"{path} cannot be read: {error.strerror}.") from error
        pieces = (_piece(*found) for found in PIECE.findall(text.partition("Linker script and memory map")[2]))
        self.pieces = [p for p in pieces if p.size > 0]
        self._code = sorted((p for p in self.pieces if p.section.startswith(".text")), key=lambda p: p.address)
        self._addresses = [p.address for p in self._code]

    def code_at(self, address):
        """The piece of code at an address, or None."""
        at = bisect.bisect_right(self._addresses, address) - 1
        return self._code[at] if at >= 0 and address < self._code[at].address + self._code[at].size else None
