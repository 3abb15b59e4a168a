"""Tables of what scripts/embree.sh ran, in Markdown.

table.py WORK [JSON]: WORK has a folder for each folder of rays, with what the programs said in each round.
A ratio is taken within a round, and its median over the rounds counts, so that a machine that slows down does so for both.
"""

import json
import math
import re
import statistics
import sys
from pathlib import Path

MODE = re.compile(r"^(?P<mode>\d+ .*?)\s+(?P<cpu>[\d.]+)\s+(?P<wall>[\d.]+)$")
SINGLE = "1 "


def embree_rates(text):
    """Rates of one run by mode, with the version and the time of the build."""
    head, *lines = text.splitlines()
    version = re.search(r"embree ([\d.]+)", head).group(1)
    build = float(re.search(r"build \w+ ([\d.]+) ms", head).group(1))
    modes = (MODE.match(line) for line in lines)
    return version, build, {m["mode"]: float(m["cpu"]) for m in modes if m}


def spread(values):
    return {"median": statistics.median(values), "min": min(values), "max": max(values)}


def mean(values):
    return math.exp(statistics.fmean(map(math.log, values)))


def read_batch(place, name):
    """All rounds of one file of rays."""
    rounds = []
    for ours in sorted(place.glob(f"ambray.{name}.*.json")):
        number = ours.name.split(".")[-2]
        embree = {}
        for tree in ("medium", "high"):
            version, _, modes = embree_rates((place / f"embree.{name}.{number}.{tree}.txt").read_text())
            embree.update({f"{mode}, {tree}": rate for mode, rate in modes.items()})
        rounds.append((version, embree, json.loads(ours.read_text())["batches"][0]))
    version, modes, first = rounds[0]
    # The mode that is best over all rounds: the best of each round would favour whoever was lucky.
    median = {mode: statistics.median(r[1][mode] for r in rounds) for mode in modes}
    best = max(median, key=median.get)
    single = max((mode for mode in median if mode.startswith(SINGLE)), key=median.get)
    contenders = {}
    for i, rate in enumerate(first["rates"]):
        key = f"{rate['isa']} {rate['mode']} {rate['order']}, {rate['quality']}"
        rates = [r[2]["rates"][i]["mrays_per_s"]["median"] for r in rounds]
        contenders[key] = {
            "mrays_per_s": spread(rates),
            "to_best": spread([rate / r[1][best] for rate, r in zip(rates, rounds)]),
            "to_single": spread([rate / r[1][single] for rate, r in zip(rates, rounds)]),
        }
    return {
        "embree": version,
        "kind": first["kind"],
        "rays": first["rays"],
        "hits": first["hits"],
        "rounds": len(rounds),
        "best": {"mode": best, "mrays_per_s": spread([r[1][best] for r in rounds])},
        "single": {"mode": single, "mrays_per_s": spread([r[1][single] for r in rounds])},
        "contenders": contenders,
        "agreement": first["agreement"],
    }


def read_builds(place):
    if not (place / "ambray.builds.json").exists():
        return None
    embree = json.loads((place / "embree.builds.json").read_text())
    ours = json.loads((place / "ambray.builds.json").read_text())
    builds = [
        {"name": f"Embree {embree['embree']} {b['quality']}", "bytes_per_triangle": b["bytes"] / embree["triangles"], **b}
        for b in embree["builds"]
    ]
    return builds + [{"name": f"Ambray {b['quality']}, width {b['width']}", **b} for b in ours["builds"]]


def row(cells):
    return "| " + " | ".join(cells) + " |"


def table(head, rows):
    return "\n".join([row(head), row(["---"] * len(head)), *map(row, rows)])


def batch_table(name, folders):
    """One file of rays in all folders."""
    batches = {title: folder["batches"][name] for title, folder in folders.items() if name in folder["batches"]}
    some = next(iter(batches.values()))
    total = sum(batch["rays"] for batch in batches.values())
    lines = [
        f"### {name}: {some['kind']} hits, {total / 1e6:.1f} million rays, {some['rounds']} rounds",
        "",
        "Million rays a second; over Embree's best mode; over its single rays. In brackets lowest and highest of the rounds.",
        "",
    ]

    def embree(which):
        cells = [f"{b[which]['mrays_per_s']['median']:.1f} ({b[which]['mode']})" for b in batches.values()]
        return [f"Embree {some['embree']}, {'best mode' if which == 'best' else 'single rays'}", *cells, ""]

    rows = [embree("best"), embree("single")]
    for key in some["contenders"]:
        if not all(key in batch["contenders"] for batch in batches.values()):
            continue  # packets in the order of another folder
        all_of = [batch["contenders"][key] for batch in batches.values()]
        cells = [
            f"{c['mrays_per_s']['median']:.1f}; **{c['to_best']['median']:.2f}** "
            f"({c['to_best']['min']:.2f} to {c['to_best']['max']:.2f}); {c['to_single']['median']:.2f}"
            for c in all_of
        ]
        means = [mean([c[ratio]["median"] for c in all_of]) for ratio in ("to_best", "to_single")]
        rows.append([key, *cells, f"**{means[0]:.2f}**; {means[1]:.2f}"])
    cells = []
    for batch in batches.values():
        agreement = batch["agreement"]
        cells.append(
            f"{agreement['differing_hits']}; {agreement['far_hits']}; {agreement['largest_relative_difference']:.0e}"
        )
    what = "rays that one of both misses; hits farther apart than 1/1000 of the distance; largest difference of the rest"
    rows.append([what, *cells, ""])
    lines.append(table(["", *batches, "geometric mean"], rows))
    return "\n".join(lines)


def build_table(folders):
    folders = {title: folder["builds"] for title, folder in folders.items() if folder["builds"]}
    if not folders:
        return None
    rows = []
    for i, build in enumerate(next(iter(folders.values()))):
        cells = []
        for builds in folders.values():
            time = builds[i]["build_ms"]
            over = time["median"] / builds[0]["build_ms"]["median"]
            cells.append(f"{time['median']:.0f} ms, {over:.2f}; {builds[i]['bytes_per_triangle']:.0f} B")
        rows.append([build["name"], *cells])
    head = "### Trees: time to build, over Embree's medium quality; bytes a triangle\n\n"
    return head + table(["", *folders], rows)


def main():
    work = Path(sys.argv[1])
    folders = {}
    for place in sorted((p for p in work.iterdir() if p.name.isdigit()), key=lambda p: int(p.name)):
        title = Path((place / "folder").read_text().strip()).name
        names = dict.fromkeys(p.name.split(".")[1] for p in sorted(place.glob("ambray.*.*.json")))
        batches = {name: read_batch(place, name) for name in names}
        folders[title] = {"batches": batches, "builds": read_builds(place)}
    names = dict.fromkeys(name for folder in folders.values() for name in folder["batches"])
    parts = [batch_table(name, folders) for name in names] + [build_table(folders)]
    print("\n\n".join(filter(None, parts)))
    if len(sys.argv) > 2:
        Path(sys.argv[2]).write_text(json.dumps(folders, indent=2) + "\n")


main()
