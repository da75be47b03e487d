"""Judges what a soak measured."""

import json
import statistics
import subprocess

WARM_UP = 0.25  # this share of a life is not compared
SHORTEST_LIFE_S = 40.0
RSS_GROWTH = 1.10
RSS_SLACK_KB = 2_048


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else None


def flatness(usage):
    """Of each process, the longest life: early against late. Returns rows, failures."""
    rows, failures = [], []
    for name in sorted({name for name, _ in usage.lives}):
        life, samples = max(((life, samples) for (of, life), samples in usage.lives.items()
                             if of == name), key=lambda one: one[1][-1][0])
        age = samples[-1][0]
        settled = [what for at, what in samples if at >= WARM_UP * age]
        third = max(1, len(settled) // 3)
        row = {"process": name, "life": life, "seconds": round(age), "samples": len(samples)}
        for key in ("rss_kb", "fds", "threads"):
            row[key + "_first"] = statistics.median(what[key] for what in settled[:third])
            row[key + "_last"] = statistics.median(what[key] for what in settled[-third:])
            row[key + "_most"] = max(what[key] for what in settled)
        rows.append(row)
        if age >= SHORTEST_LIFE_S:
            failures += _grown(row)
    return rows, failures


def _grown(row):
    name = row["process"]
    if row["rss_kb_last"] > RSS_GROWTH * row["rss_kb_first"] + RSS_SLACK_KB:
        yield f"{name}: memory grew from {row['rss_kb_first']} to {row['rss_kb_last']} kB"
    for key in ("fds", "threads"):
        if row[key + "_last"] > row[key + "_first"]:
            yield f"{name}: {key} grew from {row[key + '_first']} to {row[key + '_last']}"


def audit_logs(terra, folder):
    """Audits each log. Returns the sums, and the findings but for what the recorder lost."""
    counts = ("steps", "verdicts", "deployed", "anchors", "unchecked", "unrecorded",
              "lookups_given")
    sums = {"logs": 0, "clean": 0, "notes": 0, **dict.fromkeys(counts, 0), "lost": {}}
    failures = []
    for log in sorted(folder.glob("*.lcmlog")):
        audit = _json([terra, "log", "audit", log, "--json"])
        info = _json([terra, "log", "info", log, "--json"])
        if audit is None or info is None:
            failures.append(f"{log.name}: cannot be read")
            continue
        sums["logs"] += 1
        sums["clean"] += audit["clean"]
        for key in counts:
            sums[key] += audit[key]
        sums["notes"] += len(audit["notes"])
        for finding in audit["findings"]:
            if _lost_by_recorder(finding, info):
                kind = finding["kind"]
                sums["lost"][kind] = sums["lost"].get(kind, 0) + 1
            else:
                failures.append(f"{log.name}: {finding['kind']}, decision "
                                f"{finding['decision']}: {finding['what']}")
    return sums, failures


def _json(command):
    done = subprocess.run(command, capture_output=True, check=False)
    try:
        return json.loads(done.stdout)
    except ValueError:
        return None


# Where the numbers of their senders show that messages are missing in a log.
_CHANNELS_OF = {"gap": ("TERRA_GATE_STEP", "TERRA_VERDICT", "TERRA_DEPLOYED"),
                "missing input": ("TERRA_MAP_HEADER", "TERRA_MAP_TILE")}


def _lost_by_recorder(finding, info):
    """The soak kills and stops the recorder. What that costs, the log says by itself: its end
    has no seal, or numbers are missing."""
    if finding["kind"] == "damage":
        return not info["closed"] and "have no seal" in finding["what"]
    return any(info["channels"].get(channel, {}).get("missing", 0) > 0
               for channel in _CHANNELS_OF.get(finding["kind"], ()))
