"""What volcomp identify made of the files of a case, against what an independent implementation found.

    identification_check.py IDENTIFIED.json WANTED.json
"""

import json
import sys

found, wanted = (json.load(open(path)) for path in sys.argv[1:])
out, tolerance = wanted["out"], wanted["tol"]
functions = {f["name"]: f for f in found["functions"]}
values = {v["name"]: v for v in found["values"]}
compared = 0


def compare(name, value, want, tol):
    global compared
    compared += 1
    # Texts of numbers in the files have 15 digits or more; degrees and radians were turned into each other.
    assert abs(value - want) <= tol + 2e-9, (name, value, want, tol)


for group, unit in (("linear", 1e-3), ("angular", 1e-6)):
    for name, list in out.get(group, {}).items():
        # Every fourth of 21 places, 20 of a full turn, is every second of eleven targets.
        for k, want in enumerate(list):
            f = functions[name]
            compare(name, unit * f["value"][2 * k], want, tolerance[group])
            if "u" in out:
                compare(f"u of {name}", unit * f["u"][2 * k], out["u"][group][name][k], tolerance[f"u.{group}"])
for kind, prefix in (("reversal", "rev "), ("location", ""), ("constant", "")):
    for of, unit in (("mm", 1e-3), ("rad", 1e-6)):
        for name, want in out.get(f"{kind}_{of}", {}).items():
            compare(name, unit * values[prefix + name]["value"], want, tolerance[f"{kind}_{of}"])
if "chi2" in out:
    compare("chi2", found["chi2"], out["chi2"], tolerance["chi2"])
    assert found["dof"] == out["dof"], (found["dof"], out["dof"])
if "outliers" in out:
    names = [s["name"] for s in found["setups"]]
    got = [[names.index(o["setup"]), o["observation"] - 1] for o in found["outliers"]]
    assert got == out["outliers"], (got, out["outliers"])
assert compared >= 8, compared
print(f"{compared} values agree")
