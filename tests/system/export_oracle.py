"""Known errors of a three-axis machine as run files, and what controllers must be told about them.

Only X errs, and only by functions with a formula: positioning and two straightnesses, no angle. So every entry of every
file is known without the program: plus or minus the formula, up to one constant per axis (a shift of the zero point).
"""
import json
import re
import sys
from pathlib import Path

LO = {"X": -500.0, "Y": -300.0, "Z": -400.0}
TARGETS = 11
HALF_REVERSAL = 0.002
# Symmetric about the middle, so that the builder finds no slope to take out of the straightness.
MIDDLE = -250.0


def exx(x):
    return 2e-4 * x


def eyx(x):
    return 1e-7 * (x - MIDDLE) ** 2


def ezx(x):
    return -3e-7 * (x - MIDDLE) ** 2


def write(folder):
    for axis, lo in LO.items():
        lines = [f"target [mm],run,direction,EX{axis} [mm],EY{axis} [mm],EZ{axis} [mm],"
                 f"EA{axis} [rad],EB{axis} [rad],EC{axis} [rad]"]
        for direction, side in (("up", 1), ("down", -1)):
            for i in range(TARGETS):
                q = lo * (1 - i / (TARGETS - 1))
                e = (exx(q) + side * HALF_REVERSAL, eyx(q), ezx(q)) if axis == "X" else (0, 0, 0)
                lines.append(f"{q!r},1,{direction},{e[0]!r},{e[1]!r},{e[2]!r},0,0,0")
        Path(folder, f"runs_{axis}.csv").write_text("\n".join(lines) + "\n")


def siemens(path):
    text = Path(path).read_text().splitlines()
    assert text[1] == "CHANDATA(1)" and text[-1] == "M17", path
    number = {m[1]: float(m[2]) for m in (re.match(r"\$A\w_\w+?_(STEP|MIN|MAX)\[.*\]=(.*)", t) for t in text) if m}
    entries = [float(m[1]) for m in (re.match(r"\$A(?:A_ENC_COMP|N_CEC)\[\w+,\w+(?:,\w+)?\]=(\S+)$", t) for t in text) if m]
    assert abs(number["MIN"] + number["STEP"] * (len(entries) - 1) - number["MAX"]) < 1e-5
    return [(number["MIN"] + number["STEP"] * k, v) for k, v in enumerate(entries)]


def linuxcnc(path):
    return [tuple(map(float, line.split())) for line in Path(path).read_text().splitlines()]


def isg(path):
    keys = dict(line.split() for line in Path(path).read_text().splitlines())
    n = int(keys["kw.ssfk.kw_nr_max"])
    return [tuple(int(keys[f"kw.ssfk.table[{k}].{c}"]) / 1e4 for c in ("setpoint", "pos", "neg")) for k in range(n)]


def is_formula(pairs, formula, tolerance, what):
    """Entry − formula is one constant; at the targets, between which the interpolation is not a formula's."""
    targets = [(q, v) for q, v in pairs if abs(q / 50.0 - round(q / 50.0)) < 1e-6]
    assert len(targets) == TARGETS, (what, len(targets))
    rest = [v - formula(q) for q, v in targets]
    assert max(rest) - min(rest) < tolerance, (what, rest)


def check(folder, figures):
    folder = Path(folder)
    fine, coarse = 2.5e-6, 1.5e-4
    # The actual value gets the entry: plus the error. The setpoint gets it: minus the error.
    is_formula(siemens(folder / "siemens_enc_comp_x.ini"), exx, fine, "enc_comp x")
    is_formula(siemens(folder / "siemens_cec_x_to_y.ini"), lambda x: -eyx(x), fine, "cec x to y")
    is_formula(siemens(folder / "siemens_cec_x_to_z.ini"), lambda x: -ezx(x), fine, "cec x to z")
    for name in ("enc_comp_y", "enc_comp_z", "cec_y_to_x", "cec_y_to_z", "cec_z_to_x", "cec_z_to_y"):
        values = {v for _, v in siemens(folder / f"siemens_{name}.ini")}
        assert len(values) == 1, name
    comp = linuxcnc(folder / "linuxcnc_x.comp")
    ssfk = isg(folder / "isg_ssfk_x.lis")
    for column, side in ((1, 1), (2, -1)):
        is_formula([(r[0], r[column]) for r in comp], lambda x: -exx(x), fine, "comp x")
        is_formula([(r[0], r[column]) for r in ssfk], exx, coarse, "ssfk x")
    for row in comp:
        assert abs(row[1] - row[2] + 2 * HALF_REVERSAL) < fine, row
    for row in ssfk:
        assert abs(row[1] - row[2] - 2 * HALF_REVERSAL) < coarse, row
    # All three files of X say the same, the constant included.
    own = siemens(folder / "siemens_enc_comp_x.ini")
    for (q, entry), row, isg_row in zip(own, comp, ssfk):
        assert abs(q - row[0]) < 1e-6 and abs(q - isg_row[0]) < 1e-4
        assert abs(entry + (row[1] + row[2]) / 2) < fine and abs(entry - (isg_row[1] + isg_row[2]) / 2) < coarse

    said = {f["format"]: f for f in json.loads(Path(figures).read_text())["formats"]}
    # No angles: a sum of functions of one axis is all there is. Without the cross tables the straightness is left:
    # its parabola of 6.25 and 18.75 um about its own mean, most at the ends or in the middle.
    assert max(said["siemens"]["not_represented_max_um"]) < 0.003, said["siemens"]
    x, y, z = said["linuxcnc"]["not_represented_max_um"]
    assert x < 0.003 and 6.25 / 2 < y < 6.25 and abs(z - 3 * y) < 0.01, (x, y, z)
    assert said["isg"]["not_represented_max_um"] == said["linuxcnc"]["not_represented_max_um"]
    assert abs(json.loads(Path(figures).read_text())["reversal_um"][0] - 4.0) < 0.003


if __name__ == "__main__":
    if sys.argv[1] == "write":
        write(sys.argv[2])
    else:
        check(*sys.argv[2:])
