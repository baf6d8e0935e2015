"""Calls through pointers that an image may contain, who makes them and where they may lead. Any other is a failure."""
import dataclasses
import re
import struct


@dataclasses.dataclass(frozen=True)
class VirtualCall:
    """A call of a virtual function through an interface that these classes implement."""
    caller: str   # regular expression for the whole demangled name of the calling function
    classes: str  # regular expression for the whole demangled name of a class with a virtual table
    why: str

    def targets(self, image, slot):
        if slot is None:
            return set()
        pattern = re.compile(f"vtable for ({self.classes})")
        found = set()
        for table in image.symbols:
            # Itanium C++ ABI, 2.5.2: offset to top and type information precede the first virtual function.
            if table.size >= 12 + slot and pattern.fullmatch(image.plain(table)):
                found.add(struct.unpack("<I", image.read(table.address + 8 + slot, 4))[0] & ~1)
        return found


@dataclasses.dataclass(frozen=True)
class PointerCall:
    """A call of a function whose address was stored."""
    caller: str
    functions: str  # regular expression for the whole demangled name of a function that may be called
    why: str

    def targets(self, image, slot):
        return {symbol.address for symbol in image.find(re.compile(self.functions))}


CALLS = (
    VirtualCall(r"volcomp::canopen::SdoServer::.*", r"volcomp::canopen::Device<volcomp::node::Node>",
                "canopen::ObjectAccess: the SDO server reads and writes objects of the device"),
    VirtualCall(r"volcomp::node::StorePart::(load|save_record|erase_records)\(.*", r"volcomp::node::RecordStorage<.*>",
                "node::Storage: tables and settings in non-volatile memory"),
    VirtualCall(r"volcomp::node::(Preemptible::~?Preemptible|ProbePath::point_of|FlankProbe::derive_gear|Node::reset_\w+|"
                r"ScrubPart::read_slices|StorePart::(save_record|erase_records))\(.*", r"volcomp::node::NodeTask<.*>",
                "node::Preemption: lets the tick in while the background works for long"),
    PointerCall(r"volcomp::canopen::Pdo::configure\(.*", r"volcomp::node::arrival_of\(.*",
                "canopen::Dictionary::arrival: what the values of a PDO mean to the node"),
)
