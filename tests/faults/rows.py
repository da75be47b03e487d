"""The rows of the fault suite: what each is, and how it is run."""
import collections

Row = collections.namedtuple("Row", "name covers flaws short limit_s lossy act")
ROWS = []


def row(name, covers, flaws, short=False, limit_s=1.0, lossy=False):
    """Declares a row.

    covers: the lines of the fault tables it stands for.
    flaws: broken stand-ins (flawed/), each of which must make it fail.
    limit_s: a valid baseline is deployed within so long (a bound for "never
    blocked", far above what is usual; the table has the measured worst).
    lossy: the observer cannot hear all of it either, and says how much it missed.
    act(rig) injects, judges, and returns what was observed.
    """
    def add(act):
        ROWS.append(Row(name, covers, flaws, short, limit_s, lossy, act))
        return act
    return add
