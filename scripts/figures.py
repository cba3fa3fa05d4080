#!/usr/bin/env python3
"""Fills scripts/paper/claims.md with what the sweeps measured: writes docs/claims.md. Arguments: the folder of the sweeps' results."""

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEMPLATE = ROOT / "scripts" / "paper" / "claims.md"


class Rows:
    """The results of a sweep."""

    def __init__(self, folder, name):
        lines = (folder / name / "results.jsonl").read_text().splitlines()
        self.rows = [row for row in map(json.loads, lines) if row.get("result")]
        if not self.rows:
            sys.exit(f"figures: no results in {folder / name}")

    def find(self, **keys):
        """The only result with these facts."""
        found = [row for row in self.rows if all(facts(row)[key] == value for key, value in keys.items())]
        if len(found) != 1:
            sys.exit(f"figures: {len(found)} results of {keys}")
        return found[0]

    def each(self, key, **keys):
        """Values of a fact, in order of the rows."""
        values = [facts(row)[key] for row in self.rows if all(facts(row)[k] == v for k, v in keys.items())]
        return list(dict.fromkeys(values))


def facts(row):
    setup = row["result"]["setup"]
    eye = setup["view"]["eye"]
    return {
        "scene": row["scene"],
        "eye": round(sum(v * v for v in eye) ** 0.5, 2),
        "radii": setup["view"].get("distance"),
        "method": setup["method"]["name"],
        "machine": setup["machine"]["label"],
        "set": " ".join(setup["machine"]["set"]),
    }


def gains(lod, bvh):
    """Energy, time and DRAM of the baseline over ours."""
    a, b = lod["result"], bvh["result"]
    return [b["energy"]["total"] / a["energy"]["total"], b["cycles"] / a["cycles"], b["dram"]["reads"] / a["dram"]["reads"]]


def times(value):
    return f"{value:.1f}" if value < 9.95 else f"{value:.0f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" + "---:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def figure11(data, values):
    rows, largest, boxes = [], {}, {}
    for scene in data.each("scene"):
        for eye in data.each("eye", scene=scene):
            cells = [scene, f"{eye:.2f}"]
            for machine in ["haydel2023-ddr3", "haydel2023"]:
                lod, bvh, wide = (data.find(scene=scene, eye=eye, machine=machine, method=m) for m in ["lod", "bvh", "bvh32"])
                gain = gains(lod, bvh)
                cells += map(times, gain if machine == "haydel2023-ddr3" else gain[:2])
                for what, value in zip(["energy", "time", "dram"], gain):
                    largest.setdefault((machine, what), []).append((value, scene, eye))
                more = gains(bvh, wide)
                boxes.setdefault((machine, "energy"), []).append(more[0])
                boxes.setdefault((machine, "time"), []).append(more[1])
            rows.append(cells)
    values["figure11"] = table(["scene", "eye at", "energy, DDR3", "time", "DRAM lines", "energy, GDDR5", "time"], rows)
    for (machine, what), all_of_them in largest.items():
        name = "ddr3" if machine.endswith("ddr3") else "gddr5"
        value, scene, eye = max(all_of_them)
        values[f"most_{what}_{name}"] = f"{times(value)} ({scene}, {eye:.2f})"
        values[f"least_{what}_{name}"] = times(min(all_of_them)[0])
        values[f"range_{what}_{name}"] = f"{times(min(all_of_them)[0])} to {times(value)}"
    for (machine, what), all_of_them in boxes.items():
        name = "ddr3" if machine.endswith("ddr3") else "gddr5"
        values[f"boxes_{what}_{name}"] = f"{100 * min(all_of_them) - 100:.0f} to {100 * max(all_of_them) - 100:.0f} %"


def terrains(data, others, values):
    rows = []
    for scene in data.each("scene"):
        for eye in data.each("eye", scene=scene):
            lod = data.find(scene=scene, eye=eye, method="lod")
            line = [("line, 4", data.find(scene=scene, eye=eye, method="bvh"))]
            line += [(name, other.find(scene=scene, eye=eye)) for name, other in others.items()]
            best = [min(line, key=lambda entry: entry[1]["result"][key] if key == "cycles" else entry[1]["result"][key]["total" if key == "energy" else "reads"]) for key in ["energy", "cycles", "dram"]]
            gain = [gains(lod, bvh)[k] for k, (_, bvh) in enumerate(best)]
            image = lod["image"]
            error = [f"{image['geometry_pixels_mean']:.3f}", f"{image['rmse']:.2f}"]
            rows.append([scene, f"{eye:.2f}", *map(times, gain), best[0][0], *error])
    values["terrains"] = table(["scene", "eye at", "energy", "time", "DRAM lines", "best leaves (energy)", "surface off, pixels", "RMSE of 255"], rows)


def units(free, charged, values):
    rows = []
    radii_of_all = free.each("radii")

    def free_gains(radii, name):
        return gains(*(free.find(radii=radii, method=m, set=name) for m in ["lod", "bvh"]))

    for name in charged.each("set"):
        keys = dict(part.split("=") for part in name.split())
        per_group, contexts = int(keys.get("units.per_group", 1)), int(keys["units.contexts"])
        rays = per_group * contexts / 16
        cells = [per_group, contexts, f"{rays:g}"]
        for radii in radii_of_all:
            # With fewer rays than cores, some cores would have none: one ray each is what there is to compare with.
            whole = free_gains(radii, f"cores.rays_in_flight={max(rays, 1):g}")
            gain = gains(*(charged.find(radii=radii, method=m, set=name) for m in ["lod", "bvh"]))
            cells += [times(gain[1]), f"{100 * gain[1] / whole[1]:.0f} %", times(gain[0]), f"{100 * gain[0] / whole[0]:.0f} %"]
        rows.append((per_group, contexts, cells))
    head = ["units per group", "contexts", "rays per core"]
    for radii in radii_of_all:
        head += [f"time at {radii:g} radii", "kept", "energy", "kept"]
    values["units"] = table(head, [cells for *_, cells in sorted(rows, key=lambda row: row[:2])])
    rows = []
    for name in free.each("set"):
        cells = [name.split("=")[1]]
        for radii in radii_of_all:
            cells += [times(g) for g in free_gains(radii, name)]
        rows.append(cells)
    head = ["rays per core"] + [f"{what} at {radii:g} radii" for radii in radii_of_all for what in ["energy", "time", "DRAM lines"]]
    values["free"] = table(head, rows)


def sensitivity(data, values):
    rows = []
    for machine in data.each("machine"):
        for name in data.each("set", machine=machine):
            cells = [f"{machine} {name}".strip()]
            for radii in data.each("radii"):
                cells += [times(g) for g in gains(*(data.find(machine=machine, set=name, radii=radii, method=m) for m in ["lod", "bvh"]))]
            rows.append(cells)
    head = ["machine"] + [f"{what} at {radii:g} radii" for radii in data.each("radii") for what in ["energy", "time", "DRAM lines"]]
    values["sensitivity"] = table(head, rows)


def base_part(data, values):
    rows = []
    for radii, scene, name in [(r, s, n) for r in data.each("radii") for s in data.each("scene") for n in data.each("set")]:
        pinned = name.partition("=")[2] or "none"
        r = data.find(scene=scene, radii=radii, set=name)["result"]
        share = 100 * r["traffic"]["l0_share_of_l1"]
        rows.append([f"{scene}, {radii:g} radii", pinned, f"{share:.0f} %", f"{r['accesses_per_ray']:.2f}", f"{r['cycles']:,}", f"{r['energy']['total']:,.0f}", f"{r['dram']['reads']:,}"])
    values["l0"] = table(["scene", "nodes pinned", "L0 part of L1 requests", "requests per ray", "cycles", "energy, uJ", "DRAM lines"], rows)


def main():
    folder = Path(sys.argv[1])
    sweep = lambda name: Rows(folder, name)
    values = {}
    figure11(sweep("figure11"), values)
    others = {"indexed, 4": "terrains-indexed-4", "line, 1": "terrains-line-1", "packed, 4": "terrains-packed-4"}
    terrains(sweep("terrains"), {name: sweep(file) for name, file in others.items()}, values)
    units(sweep("free"), sweep("units"), values)
    sensitivity(sweep("sensitivity"), values)
    base_part(sweep("l0"), values)
    text = TEMPLATE.read_text()
    missing = [name for name in re.findall(r"\{\{(\w+)\}\}", text) if name not in values]
    if missing:
        sys.exit(f"figures: claims.md asks for {', '.join(missing)}")
    text = re.sub(r"\{\{(\w+)\}\}", lambda match: values[match[1]], text)
    target = ROOT / "docs" / "claims.md"
    fresh = target.with_suffix(".tmp")
    fresh.write_text(text)
    fresh.replace(target)


main()
