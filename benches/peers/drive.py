"""Runs every peer on every scene and writes docs/charts/peers.csv.

`drive.py [--only PEER[,PEER]] [--scene SCENE[,SCENE]]`: with a choice, other lines of the table stay.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

from scenes import AT_REST, IN_MOTION, ROOT

PEERS = ["moorpy", "moordyn", "cabledyn", "opensees", "exudyn", "mujoco", "pymunk", "box2d", "rapier2d"]
HEADER = ["scene", "who", "setting", "cost_s", "error", "shape_error", "note"]
TABLE = ROOT / "docs/charts/peers.csv"
# Elapsed time after which a peer that does not use CPU is ended, s.
PATIENCE_S = 300


def environment():
    """One thread each; openseespy finds its own libraries only when told where they are."""
    libraries = Path(sysconfig.get_path("purelib")) / "openseespylinux/lib"
    threads = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    return {**os.environ, **threads, "LD_LIBRARY_PATH": str(libraries)}


def ask(peer, scene):
    """The lines of one peer and scene."""
    command = [sys.executable, str(Path(__file__).with_name("one.py")), peer, scene]
    work = ROOT / "target/peers-work"
    work.mkdir(parents=True, exist_ok=True)
    try:
        done = subprocess.run(command, capture_output=True, env=environment(), cwd=work, timeout=PATIENCE_S)
        out, code = done.stdout, done.returncode
    except subprocess.TimeoutExpired as late:
        out, code = late.stdout or b"", "no end"
    points = []
    for line in out.decode(errors="replace").splitlines():
        # Some libraries print to the same line.
        at = line.find("POINT {")
        if at >= 0:
            points.append(json.loads(line[at + 6:]))
    told = any(p["note"].startswith("failed: ") and not p["setting"] for p in points)
    if code != 0 and not told:
        why = "60 s of CPU are spent" if code in (-24, -9, 152) else f"its process ended with {code}"
        points.append({"setting": "", "cost_s": None, "error": None, "shape_error": None, "note": f"failed: {why}"})
    return points


def figure(number, digits):
    """A number as in the other tables, or nothing."""
    return "" if number is None else f"{number:.{digits}e}"


def main():
    """All that is asked for, told as it goes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default=",".join(PEERS))
    parser.add_argument("--scene", default=",".join([*AT_REST, *IN_MOTION]))
    chosen = parser.parse_args()
    peers, wanted = chosen.only.split(","), chosen.scene.split(",")
    kept = []
    if TABLE.exists():
        with open(TABLE, newline="") as file:
            kept = [r for r in csv.DictReader(file) if r["who"] not in peers or r["scene"] not in wanted]
    rows = kept
    for scene in wanted:
        for peer in peers:
            points = ask(peer, scene)
            good = [p for p in points if p["error"] is not None]
            best = f"best error {min(p['error'] for p in good):.1e}" if good else points[-1]["note"] if points else "?"
            print(f"{scene:16} {peer:9} {len(good):3} points, {best}", flush=True)
            for p in points:
                rows.append({
                    "scene": scene, "who": peer, "setting": p["setting"], "cost_s": figure(p["cost_s"], 3),
                    "error": figure(p["error"], 3), "shape_error": figure(p["shape_error"], 3), "note": p["note"],
                })
    order = {name: k for k, name in enumerate([*AT_REST, *IN_MOTION])}
    rows.sort(key=lambda r: (order.get(r["scene"], 99), PEERS.index(r["who"]) if r["who"] in PEERS else 99))
    with open(TABLE, "w", newline="") as file:
        writer = csv.DictWriter(file, HEADER, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


main()
