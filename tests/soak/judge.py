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
    """Audits each log. Returns the sums and what is not explained by the log itself."""
    sums = {"logs": 0, "clean": 0, "verdicts": 0, "deployed": 0, "unrecorded": 0, "notes": 0,
            "explained": {}}
    failures = []
    for log in sorted(folder.glob("*.lcmlog")):
        audit = _json([terra, "log", "audit", log, "--json"])
        info = _json([terra, "log", "info", log, "--json"])
        if audit is None or info is None:
            failures.append(f"{log.name}: cannot be read")
            continue
        sums["logs"] += 1
        sums["clean"] += audit["clean"]
        for key in ("verdicts", "deployed", "unrecorded"):
            sums[key] += audit[key]
        sums["notes"] += len(audit["notes"])
        for finding in audit["findings"]:
            if _explained(finding, audit, info):
                kind = finding["kind"]
                sums["explained"][kind] = sums["explained"].get(kind, 0) + 1
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


def _explained(finding, audit, info):
    kind, what = finding["kind"], finding["what"]
    if kind == "damage":
        # Killed between a write and its seal.
        return not info["closed"] and "have no seal" in what
    channels = info["channels"]
    if kind == "gap":
        return any(channels.get(name, {}).get("missing", 0) > 0
                   for name in ("TERRA_VERDICT", "TERRA_DEPLOYED"))
    # Under a flood gate and recorder look at other parts of it.
    advice = channels.get("TERRA_ADVICE", {})
    flooded = advice.get("missing", 0) + advice.get("malformed", 0) > 0
    if kind == "missing input" and "ADVICE" in what:
        return flooded
    if kind == "mismatch":
        # An advisor was impersonated (the audit notes say so): of two messages
        # under its name the log lacks the one that was judged. That explains no
        # verdict about where the robot was or what was in force.
        return (flooded and bool(audit["notes"]) and "VERDICT" in what
                and "late" not in what and "stale" not in what)
    # It may stand in the log before, where this one begins in mid-run.
    return kind == "missing input" and audit["anchors"] > 0
