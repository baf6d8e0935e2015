#!/usr/bin/python3
"""The CAN database and the EDS of firmware/, read with parsers somebody else wrote.

    device_files_test.py PROJECT_FOLDER

canmatrix (Debian: python3-canmatrix) reads the database and decodes frames written by hand;
configparser reads the EDS, strictly: nothing may be there twice.
"""

import configparser
import pathlib
import sys
import unittest

import canmatrix.formats

PROJECT = pathlib.Path(sys.argv.pop(1))


class Database(unittest.TestCase):
    def setUp(self):
        self.bus = canmatrix.formats.loadp_flat(str(PROJECT / "firmware/volcomp.dbc"))

    def frame(self, can_id):
        frame = self.bus.frame_by_id(canmatrix.ArbitrationId(can_id, extended=False))
        self.assertIsNotNone(frame, f"no frame {can_id:03X}h")
        return frame

    def decode(self, can_id, text):
        data = bytes.fromhex(text)
        frame = self.frame(can_id)
        self.assertEqual(frame.size, len(data))
        return {name: signal.raw_value for name, signal in frame.decode(data).items()}

    def test_process_state(self):
        # Slot 78, in the face, backward, 13.4 mm/s.
        self.assertEqual(self.decode(0x1FF, "4E 00 09 00 C0 77 CC 00"),
                         {"Slot": 78, "StrokeFlags": 9, "StrokeFeed": 13400000})

    def test_temperatures(self):
        # 23.5, -1.25 and no sensor at all.
        self.assertEqual(self.decode(0x2FF, "2E 09 83 FF 00 80 00 80"),
                         {"Temperature0": 2350, "Temperature1": -125, "Temperature2": -32768, "Temperature3": -32768})
        self.assertEqual(float(self.frame(0x2FF).signal_by_name("Temperature0").factor), 0.01)

    def test_time(self):
        # 1 January 2000, one in the morning: 5844 days after 1 January 1984.
        self.assertEqual(self.decode(0x100, "80 EE 36 00 D4 16"), {"Milliseconds": 3600000, "Days": 5844})

    def test_every_frame_has_its_place(self):
        expected = {0x000: ("NMT_Command", 2), 0x080: ("SYNC", 1), 0x0A0: ("Node_Emergency", 8),
                    0x1A0: ("Node_Status", 8), 0x2A0: ("Point", 8), 0x3A0: ("Point_XY", 8),
                    0x4A0: ("Point_Z", 8), 0x5A0: ("Node_SdoResponse", 8),
                    0x620: ("Node_SdoRequest", 8), 0x720: ("Node_Heartbeat", 1),
                    0x1FF: ("Controller_ProcessState", 8), 0x2FF: ("Controller_Temperatures", 8),
                    0x100: ("TIME", 6), 0x77F: ("Controller_Heartbeat", 1)}
        for drive, axis in enumerate("XYZ", start=1):
            per_axis = {0x080: ("Emergency", 8), 0x180: ("Actual", 8), 0x200: ("Command", 6),
                        0x280: ("Probe", 8), 0x300: ("Offset", 4), 0x380: ("ProbeCounter", 6),
                        0x480: ("HeldOffset", 4), 0x580: ("SdoResponse", 8),
                        0x600: ("SdoRequest", 8), 0x700: ("Heartbeat", 1)}
            for function, (name, size) in per_axis.items():
                expected[function + drive] = (f"{axis}_{name}", size)
        found = {f.arbitration_id.id: (f.name, f.size) for f in self.bus.frames}
        self.assertEqual(found, expected)

    def test_positions_are_signed_nanometres(self):
        places = [(0x201, "TargetPosition", 16), (0x182, "ActualPosition", 0),
                  (0x303, "PositionOffset", 0), (0x481, "PositionOffset", 0),
                  (0x281, "ProbePosition", 0), (0x381, "FollowingError", 16)]
        for can_id, name, start in places:
            signal = self.frame(can_id).signal_by_name(name)
            place = (signal.get_startbit(), signal.size, signal.is_signed, signal.is_little_endian)
            self.assertEqual(place, (start, 32, True, True), name)
            self.assertEqual((signal.unit, signal.factor, signal.offset), ("nm", 1, 0), name)

    def test_other_units(self):
        probe_time = self.frame(0x281).signal_by_name("ProbeTime")
        self.assertEqual((probe_time.unit, probe_time.is_signed, probe_time.size), ("ns", False, 32))
        self.assertEqual(self.frame(0x080).signal_by_name("SyncCounter").unit, "1")
        self.assertEqual(self.frame(0x381).signal_by_name("EdgeCounter").unit, "1")

    def test_frames_written_by_hand(self):
        frames = [
            (0x301, "D2 FF FF FF", {"PositionOffset": -46}),
            (0x201, "0F 00 40 42 0F 00", {"Controlword": 15, "TargetPosition": 1_000_000}),
            (0x182, "FF FF FF FF 37 12 01 00",
             {"ActualPosition": -1, "Statusword": 0x1237, "ProbeStatus": 1}),
            (0x283, "10 00 00 00 A0 86 01 00", {"ProbePosition": 16, "ProbeTime": 100_000}),
            (0x2A0, "07 00 00 00 06 02 01 00",
             {"PointNumber": 7, "Verdict": 6, "VerdictAxis": 2, "Feature": 1}),
            (0x3A0, "D2 FF FF FF 40 42 0F 00", {"PointX": -46, "PointY": 1_000_000}),
            (0x4A0, "FF FF FF FF 2C 01 00 00", {"PointZ": -1, "PointUncertainty": 300}),
            (0x080, "F0", {"SyncCounter": 240}),
            (0x000, "01 20", {"Command": 1, "NodeId": 32}),
            (0x0A0, "01 FF 81 02 02 00 00 00",
             {"ErrorCode": 0xFF01, "ErrorRegister": 0x81, "Source": 2, "Detail": 2}),
            (0x720, "05", {"NmtState": 5}),
            (0x620, "40 18 10 02 00 00 00 00",
             {"SdoCommand": 0x40, "Index": 0x1018, "SubIndex": 2, "Data": 0}),
            (0x1A0, "EF BE AD DE 03 11 01 20",
             {"ActiveCrc": 0xDEADBEEF, "NodeState": 3, "SyncCounter": 17,
              "AxisStatusBits": 0x2001}),
        ]
        for can_id, text, expected in frames:
            self.assertEqual(self.decode(can_id, text), expected, f"{can_id:03X}h")

    def test_coded_values_have_words(self):
        nmt = {0: "boot-up", 4: "stopped", 5: "operational", 127: "pre-operational"}
        for can_id in (0x701, 0x702, 0x703, 0x720, 0x77F):
            self.assertEqual(self.frame(can_id).signal_by_name("NmtState").values, nmt)
        state = self.frame(0x1A0).signal_by_name("NodeState")
        self.assertEqual(state.values, {0: "idle", 1: "no tables", 2: "waiting for drives",
                                        3: "compensating", 4: "degraded", 5: "background overdue"})
        error = self.frame(0x0A0).signal_by_name("ErrorCode")
        self.assertEqual(error.values[0x8130], "a node fell silent")

    def test_senders_and_receivers(self):
        self.assertEqual([e.name for e in self.bus.ecus],
                         ["Controller", "Node", "X_Drive", "Y_Drive", "Z_Drive"])
        self.assertEqual(self.frame(0x301).transmitters, ["Node"])
        self.assertEqual(self.frame(0x201).transmitters, ["Controller"])
        self.assertEqual(self.frame(0x181).transmitters, ["X_Drive"])
        self.assertEqual(self.frame(0x201).receivers, ["X_Drive", "Node"])

    def test_everything_is_explained(self):
        for frame in self.bus.frames:
            self.assertTrue(frame.comment, frame.name)
            for signal in frame.signals:
                self.assertTrue(signal.comment, f"{frame.name}.{signal.name}")


class DataSheet(unittest.TestCase):
    def setUp(self):
        self.eds = configparser.RawConfigParser(strict=True)
        self.eds.read(PROJECT / "firmware/volcomp.eds", encoding="ascii")

    def test_header(self):
        self.assertEqual(self.eds["FileInfo"]["FileName"], "volcomp.eds")
        self.assertEqual(self.eds["DeviceInfo"]["ProductNumber"], "0x564F4C43")

    def test_every_listed_object_has_a_section(self):
        for group in ("MandatoryObjects", "OptionalObjects", "ManufacturerObjects"):
            for number in range(1, self.eds.getint(group, "SupportedObjects") + 1):
                section = self.eds[group][str(number)].removeprefix("0x")
                self.assertTrue(self.eds[section]["ParameterName"], section)

    def test_defaults_of_numbers_are_whole(self):
        # lely's dcfgen evaluates them so, and refuses the file for 0.5.
        visible_string = 0x0009
        for name in self.eds.sections():
            section = self.eds[name]
            value = section.get("DefaultValue")
            if value is None or int(section["DataType"], 0) == visible_string:
                continue
            with self.subTest(section=name):
                int(value.upper().replace("$NODEID", "1").rpartition("+")[2], 0)

    def test_names_survive(self):
        self.assertEqual(self.eds["2200sub3"]["ParameterName"],
                         "Deadline after SYNC, us, 0: 60 % of the period")


if __name__ == "__main__":
    unittest.main()
