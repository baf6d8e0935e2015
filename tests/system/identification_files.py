"""A case of identification as the files of a user: machine.toml, plan.toml and a table for each set-up.

    identification_files.py CASES.json CASE_ID FOLDER    writes them, and wanted.json
"""

import json
import math
import sys

CHANNELS = ["EX", "EY", "EZ", "EA", "EB", "EC"]


def machine_toml(machine):
    """The chain from the work to the tool; every joint has its own body."""
    joints = machine["joints"]
    work = [j for j in joints if j["branch"] == "w"]
    tool = [j for j in joints if j["branch"] == "t"]
    chain = "-".join(["w"] + [j["name"] for j in reversed(work)] + ["b"] + [j["name"] for j in tool] + ["t"])
    lines = ['name = "machine of the case"', "id = 77", 'convention = "body"', 'side = "moving"', f'chain = "{chain}"',
             "[tool]", f"point_mm = {machine['tool']}"]
    for node, j in enumerate(joints, 1):
        unit = "rad" if j["kind"] == "R" else "mm"
        lines += ["[[axis]]", f'name = "{j["name"]}"', f"travel_{unit} = [{j['lo']!r}, {j['hi']!r}]", "targets = 11",
                  f"reference_{unit} = {float(j['ref'])!r}", "sensed_point_mm = [0.0, 0.0, 0.0]", "kappa = 0",
                  f"offset_mm = {j['off']}", f"sign = {j['sign']}", f"node_id = {node}", "units_per_turn = 2147483648" if unit == "rad" else "units_per_mm = 1000000"]
    lines += ["[bus]", "node_id = 32", "[correction]", 'axes = ["X", "Y", "Z"]', "limit_mm = 0.5", "[tables]", "refine = 1",
              'interpolation = "catmull_rom"']
    return "\n".join(lines) + "\n"


def channels_toml(by_axis):
    return "{ " + ", ".join(f"{axis} = {json.dumps(list)}" for axis, list in by_axis.items()) + " }"


def model_toml(model):
    lines = ["[model]", "segments = { " + ", ".join(f"{a} = {f['segments']}" for a, f in model["functions"].items()) + " }"]
    chosen = {a: f["channels"] for a, f in model["functions"].items() if "channels" in f}
    if chosen:
        lines.append(f"channels = {channels_toml(chosen)}")
    reversal = {a: f.get("reversal_channels", f.get("channels", CHANNELS)) for a, f in model["functions"].items() if "reversal" in f}
    if reversal:
        lines.append(f"reversal_channels = {channels_toml(reversal)}")
    for key in ("location", "constant"):
        lines.append(f"{key} = {channels_toml(model.get(key, {}))}")
    if model.get("gauge"):
        lines.append(f"gauge = {json.dumps(model['gauge'])}")
    if model.get("curvature"):
        lines.append(f"curvature_um = {1e3 * model['curvature'][0]!r}\ncurvature_urad = {1e6 * model['curvature'][1]!r}")
    return "\n".join(lines)


def stylus_toml(s):
    lines = ["[[stylus]]", f'name = "{s["name"]}"', f"offset_mm = {s['offset']}", f"radius_mm = {s['radius']}"]
    if s.get("fixed"):
        lines.append("reference = true")
    elif "sigma" in s:
        lines.append(f"u_mm = {s['sigma']!r}")
    if s.get("radius_unknown"):
        lines.append(f"radius_u_um = {1e3 * s['radius_sigma']!r}" if "radius_sigma" in s else 'radius_u_um = "free"')
    return "\n".join(lines)


def artefact_toml(a):
    lines = ["[[artefact]]", f'name = "{a["name"]}"', f"spheres_mm = {a['spheres']}", f"radius_mm = {a['radius']}",
             f"calibrated = {'false' if a['known'] == 'free' else 'true'}"]
    if a["known"] != "free":
        lines.append(f"u_um = {1e3 * a.get('sigma', 0.0)!r}")
    if "scale" in a:
        lines.append(scale_toml(a["scale"]))
    if a.get("lengths"):
        lines.append("lengths = [" + ", ".join(
            f"{{ a = {l['a']}, b = {l['b']}, mm = {l['length']!r}, u_um = {1e3 * l['sigma']!r} }}" for l in a["lengths"]) + "]")
    return "\n".join(lines)


def scale_toml(scale):
    return f'scale_ppm = {json.dumps(scale) if scale == "free" else repr(1e6 * scale)}'


def setup_toml(problem, s, file):
    lines = ["[[setup]]", f'name = "{s["name"]}"', f'kind = "{s["kind"]}"', f'file = "{file}"']
    if "scale" in s:
        lines.append(scale_toml(s["scale"]))
    kind, um = s["kind"], f"{1e3 * s['sigma']!r}" if not isinstance(s["sigma"], list) else None
    if kind == "touch":
        lines += [f"probe_um = {um}", f'artefact = "{problem["artefacts"][s["artefact"]]["name"]}"']
        if "pose" in s:
            p = s["pose"]
            lines.append(f"pose_deg_mm = {[math.degrees(v) for v in p[:3]] + p[3:]}")
        return "\n".join(lines)
    lines.append(f"u_um = {um}")
    if kind == "tracer":
        lines += [f"station_mm = {s['station']}", f'frame = "{s.get("frame", "work")}"']
    elif kind == "bar":
        lines += [f"socket_mm = {s['station']}", f"length_mm = {s['length']!r}", f"plane = {s['normal']}"]
        if "length_sigma" in s:
            lines.append(f"length_u_um = {1e3 * s['length_sigma']!r}")
    elif kind in ("diagonal", "step"):
        lines.append(f"along = {s['u']}")
        if kind == "step":
            lines += [f"beam_mm = {s['beam']}", f"mirror = {s['mirror']}"]
    return "\n".join(lines)


def table_csv(problem, s):
    joints = problem["machine"]["joints"]
    names = [j["name"] for j in joints]
    head = [f"{j['name']} [{'rad' if j['kind'] == 'R' else 'mm'}]" for j in joints] + ["tip"] + [f"direction {n}" for n in names]
    readings = {"tracer": ["length [mm]"], "bar": ["radial [mm]"], "rtest": ["DX [mm]", "DY [mm]", "DZ [mm]"],
             "touch": ["setup", "sphere"]}.get(s["kind"], ["displacement [mm]"])
    head += readings if "y" in s or s["kind"] == "touch" else []
    lines = [",".join(head)]
    tips = [t["name"] for t in problem["styli"]]
    for i, q in enumerate(s["q"]):
        stylus = s.get("stylus", 0)
        stylus = stylus[i] if isinstance(stylus, list) else stylus
        d = s["d"][i] if "d" in s else [0] * len(q)
        row = [repr(v) for v in q] + [tips[stylus]] + [{1: "+", -1: "-", 0: "0"}[int(v)] for v in d]
        if s["kind"] == "touch":
            row += [s["name"], str(s["sphere"][i] if isinstance(s["sphere"], list) else s["sphere"])]
        elif "y" in s:
            y = s["y"][i]
            row += [repr(v) for v in (y if isinstance(y, list) else [y])]
        lines.append(",".join(row))
    return "\n".join(lines) + "\n"


def write(problem, folder):
    plan = ['positions = "actual"', 'compensation = "off"', "temperature_C = 20.0", "[machine]", 'file = "machine.toml"',
            model_toml(problem["model"])]
    plan += [stylus_toml(s) for s in problem["styli"]] + [artefact_toml(a) for a in problem["artefacts"]]
    for k, s in enumerate(problem["setups"]):
        plan.append(setup_toml(problem, s, f"setup_{k}.csv"))
        with open(f"{folder}/setup_{k}.csv", "w") as file:
            file.write(table_csv(problem, s))
    with open(f"{folder}/machine.toml", "w") as file:
        file.write(machine_toml(problem["machine"]))
    with open(f"{folder}/plan.toml", "w") as file:
        file.write("\n".join(plan) + "\n")


if __name__ == "__main__":
    cases, name, folder = sys.argv[1:]
    case = next(c for c in json.load(open(cases))["cases"] if c["id"] == name)
    write(case["in"]["problem"], folder)
    with open(f"{folder}/wanted.json", "w") as file:
        json.dump({"out": case["out"], "tol": case["tol"]}, file)
