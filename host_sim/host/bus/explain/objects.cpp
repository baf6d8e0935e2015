// What each object of the node is for. Names, types, ranges and defaults come from the code
// (device_files/eds_objects.hpp); these texts add what a table does not hold.

#include <array>

#include "host_sim/host/bus/explain/explanation.hpp"

namespace volcomp::host {
namespace {

struct Purpose {
  unsigned first;
  unsigned last;
  const char* text;
};

constexpr std::array kPurposes{
    Purpose{0x1000, 0x1000, "What the device is: no standard profile of CiA covers compensation."},
    Purpose{
        0x1001, 0x1001,
        "One bit per class of error that is active now. Bit 0 any, bit 4 communication, bit 7 one "
        "of this device."},
    Purpose{0x1003, 0x1003,
            "The latest eight emergency codes, newest first. Writing 0 to sub-index 0 clears it."},
    Purpose{0x1005, 0x1005,
            "Identifier of SYNC. Bit 30 makes the node its producer, where there is no controller "
            "that does."},
    Purpose{
        0x1006, 0x1006,
        "Period of SYNC in us. The node needs it for the deadline, for speeds and as producer."},
    Purpose{0x1007, 0x1007,
            "Synchronous frames later than this after SYNC do not belong to the cycle any more."},
    Purpose{0x1008, 0x100A, "Name and versions of the device, as text."},
    Purpose{
        0x1010, 0x1010,
        "Writing \"save\" (65766173h) to sub-index 1 stores parameters and active tables. Refused "
        "while OPERATIONAL. Reads 0 where there is no store."},
    Purpose{0x1011, 0x1011,
            "Writing \"load\" (64616F6Ch) to sub-index 1 forgets what is stored; defaults hold "
            "after the next reset. Reads 0 where there is no store."},
    Purpose{0x1012, 0x1012,
            "Identifier of TIME, which gives the node the date; bit 31: it listens. Needed for "
            "tables that expire."},
    Purpose{0x1014, 0x1015, "Identifier of emergency messages, and the shortest time between two."},
    Purpose{
        0x1016, 0x1016,
        "Nodes whose heartbeats are watched, and for how long they may be silent: the drives and "
        "the controller. Node << 16 | ms; not used with time 0, node 0 or a node above 127."},
    Purpose{0x1017, 0x1017, "Period of the node's own heartbeat in ms."},
    Purpose{0x1018, 0x1018, "Vendor, product, revision and serial number."},
    Purpose{
        0x1019, 0x1019,
        "Where the counter in SYNC begins again, in all devices alike; 0: SYNC has no counter."},
    Purpose{
        0x1020, 0x1020,
        "Date and time of the configuration, kept as written: a controller that finds its own here "
        "need not configure again."},
    Purpose{0x1029, 0x1029,
            "What the node does when the controller falls silent: 0 PRE-OPERATIONAL, 1 nothing, 2 "
            "STOPPED."},
    Purpose{0x1200, 0x1200, "Identifiers of the SDO server."},
    Purpose{0x1400, 0x15FF,
            "How a frame of a drive or of the controller is received: identifier (bit 31: off) and "
            "type. Fixed in OPERATIONAL, temperatures apart."},
    Purpose{0x1600, 0x17FF, "Where its bytes go: 2011h to 201Ah, 2700h."},
    Purpose{
        0x1800, 0x19FF,
        "How a frame is sent: offsets to the drives when the cycle is complete, state and points "
        "to the controller. Bit 30 of a valid identifier is 1: remote requests are not answered. "
        "Those of the offsets are fixed in OPERATIONAL."},
    Purpose{0x1A00, 0x1BFF, "What a sent frame contains, in this order."},
    Purpose{
        0x2000, 0x2000,
        "Whose tables are accepted (0: of any machine), who the controller is, and whether the "
        "errors are taken at the "
        "target (607Ah) or at the actual position (6064h). Sub-indices 4 and 5 tell the machine "
        "that is active."},
    Purpose{0x2010, 0x2010, "Drive of each axis; writing it sets the PDOs of the axis."},
    Purpose{0x2011, 0x2012,
            "Process data from the controller to the drive, which the node overhears."},
    Purpose{0x2013, 0x2016, "Process data of the drive."},
    Purpose{0x2017, 0x2019,
            "What the drive latched at the edge of the probe, when, and how often."},
    Purpose{0x201A, 0x201A, "What a grinder of helical gears does at the targets of this cycle."},
    Purpose{0x2020, 0x2020, "The offset that is sent to the drive, in its position units."},
    Purpose{
        0x2030, 0x2031,
        "Scale of each drive as an exact fraction: run-time units (nm, or 2^-40 turn) per position "
        "unit."},
    Purpose{0x2032, 0x2032, "Linear or rotary; must agree with the tables."},
    Purpose{0x2033, 0x2033,
            "Bits of 6041h that must all be set before positions of the axis are believed."},
    Purpose{
        0x2110, 0x2110,
        "New tables go here by SDO, best as a block. Sub-index 2 is their checksum as received; "
        "nothing is in force yet."},
    Purpose{0x2111, 0x2111,
            "1 validate, 2 arm, 3 activate: each includes the ones before it. 4 deactivate, 5 "
            "forget the staged image."},
    Purpose{
        0x2112, 0x2112,
        "How far the tables have come, which are active (CRC-32, sequence number), and of the last "
        "refusal reason, axis, knot, channel and a sentence."},
    Purpose{0x2200, 0x2200,
            "Times in cycles: ramp of changes, patience with missing data; deadline in the cycle; "
            "whether drives report 60B0h."},
    Purpose{0x2201, 0x2201,
            "Corrections beyond this are cut off and told. nm or 2^-32 turn, whatever the drive "
            "counts in."},
    Purpose{
        0x2202, 0x2202,
        "No offset moves by more than this in one cycle, whatever happens; corrections follow with "
        "a (2 x 2200h:04 + 3)th of it, so that this holds when frames are late. nm or 2^-32 turn."},
    Purpose{0x2203, 0x2203,
            "The slower step per cycle of an axis that is dropped, not referenced or coming back. "
            "nm or 2^-32 turn."},
    Purpose{0x2204, 0x2204,
            "Motion smaller than this does not change the direction of travel. nm or 2^-32 turn."},
    Purpose{0x2205, 0x2205,
            "A position that moves farther in one cycle is not believed. nm or 2^-40 turn; 0: not "
            "checked."},
    Purpose{0x2206, 0x2206,
            "For drives that cannot report it: the offset they hold, written before the start. nm "
            "or 2^-32 turn."},
    Purpose{0x2300, 0x2300,
            "Switches probing on with the settings of 2301h to 2306h, or off; sub-index 5 says why "
            "they were refused."},
    Purpose{0x2301, 0x2301, "Delay of each drive's probe input."},
    Purpose{0x2302, 0x2302,
            "How the ball acts by direction: a constant, then spherical harmonics to third order, "
            "frame of the tool."},
    Purpose{0x2303, 0x2303,
            "Where the part stands on its holder: rotation by rows, then position."},
    Purpose{0x2304, 0x2306, "Standard uncertainties, from which that of every point is made."},
    Purpose{0x2310, 0x2310,
            "What is touched next. The number is written last and takes the rest over."},
    Purpose{
        0x2311, 0x2313,
        "A face gear, and the flank of it that is touched next: its touches are judged at once."},
    Purpose{0x2400, 0x2400, "How many points wait, were lost, were touched, were rejected."},
    Purpose{0x2401, 0x2401, "The latest point, as the frames tell it."},
    Purpose{0x2410, 0x2411, "The oldest point that waits, whole; writing its number releases it."},
    Purpose{0x2500, 0x2505,
            "Settings of the stroke monitor of a helical grinder: axes, gear, nodes, lines to be "
            "watched, learning."},
    Purpose{0x2510, 0x2516,
            "What was watched: samples by what became of them, signals on the flank by direction, "
            "means by node."},
    Purpose{0x2520, 0x2525, "Learning: commands, what became of each table, what is in force."},
    Purpose{0x2526, 0x2526, "The learned tables as one block, to be read and written."},
    Purpose{
        0x2600, 0x2600,
        "State of the node and what it has counted; what it found in its memory at the start, and "
        "why it started."},
    Purpose{0x2601, 0x2602, "Status word and largest offset of each axis."},
    Purpose{0x2610, 0x2614,
            "How often each status bit of the axis began. Sub-index 1 is bit 0. Saturates."},
    Purpose{0x2700, 0x2701,
            "How warm the axes are, by input, from a PDO of the controller or over SDO, and what "
            "the node thinks of it: what is missing or cannot be true is not used."},
    Purpose{0x2702, 0x2702,
            "From what change of the growth on the tables follow, and for how long a temperature "
            "may fail to come."},
    Purpose{0x2703, 0x2703,
            "Whether the tables are those of the temperatures in use, how far behind, and how "
            "often they followed."},
    Purpose{0x2704, 0x2704,
            "The date, from TIME or written here, and until when the active tables hold."},
};

}  // namespace

const char* purpose(unsigned index) {
  for (const Purpose& p : kPurposes) {
    if (index >= p.first && index <= p.last) return p.text;
  }
  return nullptr;
}

}  // namespace volcomp::host
