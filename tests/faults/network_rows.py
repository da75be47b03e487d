"""Networks that lose, double, reorder, delay, corrupt, and go away."""
import struct
import time

import field
import lcm_bus
import wire
from rig import PORT, require
from rows import row

ELSEWHERE = PORT + 100  # the far side of a relay
LOSSY_S = 4.0  # several repetitions in a row may be lost


def shell(rig, command):
    done = rig.run("sh", "-c", command)
    require(done.returncode == 0, f"{command}: {done.stderr}")


@row("20 % of all datagrams lost, both buses", "GATE 11; LCM loss",
     ["verifier:says-once"], short=True, limit_s=LOSSY_S, lossy=True)
def loss(rig):
    shell(rig, "nft add table ip lossy && nft 'add chain ip lossy in "
               "{ type filter hook input priority 0; }' && "
               "nft add rule ip lossy in udp dport 7667-7668 numgen random mod 100 '<' 20 "
               "counter drop")
    rig.start("map", "planner", "verifier")
    rig.serve(20)
    for _ in range(25):
        rig.serve(LOSSY_S + 1)
    rig.start("searcher")
    rig.await_candidate(10)
    rules = rig.run("nft", "list", "table", "ip", "lossy").stdout
    rig.injected = int(rules.split("packets ")[1].split()[0])
    require(rig.injected > 20, "nothing was lost")
    return "all served, by repetition"


@row("advice lost, doubled, reordered, late", "GATE 10, 11; LCM loss/reorder/dup/delay",
     ["verifier:no-key"])
def advisor_behind_a_relay(rig):
    rig.define("searcher", "terra-advisor", "--name", "searcher", port=ELSEWHERE)
    with rig.relay(ELSEWHERE, lose=0.1, double=0.2, late=0.3, late_s=1.0):
        rig.set_up("searcher")
        for _ in range(20):
            rig.serve()
            rig.hear(0.3)
        rig.await_candidate(10)
    return "late and doubled advice changes nothing, the rest is accepted"


@row("advice corrupted", "GATE 5, 11", ["verifier:no-decoder"])
def corrupted_advice(rig):
    rig.define("searcher", "terra-advisor", "--name", "searcher", port=ELSEWHERE)
    with rig.relay(ELSEWHERE, corrupt=0.3):
        rig.set_up("searcher")
        accepted = 0
        for _ in range(20):
            rig.serve()
            until = time.monotonic() + 1
            while not rig.has_route((2,)) and time.monotonic() < until:
                rig.hear(0.05)
            # (An answer that was damaged and judged stays refused when repeated.)
            accepted += rig.has_route((2,))
    rig.alive("map", "planner", "verifier")
    require(5 <= accepted, f"only {accepted} of 20 came through")
    return f"damaged advice is refused; {accepted} of 20 answers came through whole"


@row("baselines lost, doubled, reordered, late", "GATE 10, 11",
     ["verifier:returns-to-old"], limit_s=LOSSY_S)
def planner_behind_a_relay(rig):
    rig.define("planner", "terra-planner", "--stride", field.STRIDE, port=ELSEWHERE)
    with rig.relay(ELSEWHERE, lose=0.1, double=0.2, late=0.3, late_s=1.0):
        rig.start("map", "planner", "verifier", "searcher")
        rig.serve(15)
        for _ in range(20):
            rig.serve(LOSSY_S)
            rig.hear(0.1)
            number = rig.request_id
            rig.hear(0.2)
            require(rig.deployed["request_id"] == number, "the gate went back to an old request")
    return "a replaced request never comes back"


@row("every third baseline lost, counted", "LCM loss (gaps in seq)", ["verifier:counts-no-loss"],
     limit_s=LOSSY_S)
def losses_counted(rig):
    rig.define("planner", "terra-planner", "--stride", field.STRIDE, port=ELSEWHERE)
    with rig.relay(ELSEWHERE, lose=1 / 3) as counts:
        rig.start("map", "planner", "verifier")
        rig.serve(15)
        first = rig.baseline["seq"]
        rig.hear(10)
        # Each gap is known by what follows it.
        heard_until = rig.baseline["seq"]
        rig.await_(lambda: rig.status["verifier"]["utime"] > rig.baseline["utime"] + 10_000
                   and rig.baseline["seq"] > heard_until, 5, "no heartbeat")
        counted = rig.counter("verifier", "lost")
    dropped = counts[PORT].get("lost TERRA_BASELINE", 0)
    require(counted > 5, f"{counted} losses counted, {dropped} dropped")
    require(dropped - first - 4 <= counted <= dropped, f"{counted} counted, {dropped} dropped")
    return f"{counted} gaps counted by the gate, {dropped} dropped (the ends cannot be counted)"


def away_for_a_second(rig, take_away, give_back):
    """Three times; then all still run and the next advice comes into force."""
    rig.set_up("searcher", "logger")
    for _ in range(3):
        shell(rig, take_away)
        rig.injected += 1
        rig.hear(1.0)
        shell(rig, give_back)
        rig.serve(4)
    rig.alive("map", "planner", "verifier", "searcher", "logger")
    rig.await_candidate()


@row("loopback down for 1 s", "LCM lo down", ["verifier:dies-on-send-error"], limit_s=4.0, lossy=True)
def loopback_down(rig):
    away_for_a_second(rig, "ip link set lo down", "ip link set lo up multicast on && "
                      "ip route replace 224.0.0.0/4 dev lo")
    return "no process ends; served again when it is back"


@row("multicast route deleted for 1 s", "LCM no route / route lost",
     ["verifier:dies-on-send-error", "verifier:counts-no-loss"], limit_s=4.0, lossy=True)
def route_lost(rig):
    away_for_a_second(rig, "ip route del 224.0.0.0/4 dev lo", "ip route add 224.0.0.0/4 dev lo")
    rig.await_(lambda: rig.counter("verifier", "send_failed") > 0, 3,
               "the gate does not count what it could not send")
    return "failed sends are counted; served again when it is back"


@row("no multicast route at the start", "LCM no route", ["second:half-alive"])
def no_route_at_the_start(rig):
    rig.set_up()
    shell(rig, "ip route del 224.0.0.0/4 dev lo")
    rig.define("second", "terra-verifier", "--name", "second")
    rig.start("second")
    rig.injected = 1
    rig.await_(lambda: not rig["second"].running(), 5, "it starts without a route")
    words = rig["second"].last_words()
    require("no route for multicast" in words, f"no clear error: {words}")
    shell(rig, "ip route add 224.0.0.0/4 dev lo")
    return "refuses to start and says what to do"


@row("firewall drops the deployed bus for 1 s", "LCM firewall drop",
     ["verifier:ends-in-silence"], limit_s=4.0, lossy=True)
def firewall(rig):
    away_for_a_second(rig, "nft add table ip wall && nft 'add chain ip wall in "
                      "{ type filter hook input priority 0; }' && "
                      "nft add rule ip wall in udp dport 7667 drop", "nft delete table ip wall")
    return "served again when it is lifted"


@row("a fragment doubled in another's place, on the deployed bus", "GATE 7",
     ["verifier:no-digest"])
def doubled_fragment(rig):
    rig.set_up()
    for number in range(20):
        rig.serve()
        waypoints = rig.optimum(rig.ends)
        forged = dict(rig.baseline, baseline_digest=number + 1, num_waypoints=len(waypoints),
                      waypoint_x=[x for x, _ in waypoints], waypoint_y=[y for _, y in waypoints])
        data = wire.encode("baseline", forged)
        body = b"TERRA_BASELINE\0" + data
        part = -(-len(body) // 3)
        for index in (0, 1, 1):
            head = struct.pack(">IIIIHH", lcm_bus.FRAGMENT, 1_000 + number, len(data),
                               index * part, index, 3)
            rig.deployed_bus.send(head + body[index * part:(index + 1) * part])
        # And the whole of it, with the digest of another route.
        rig.deployed_bus.say_raw("TERRA_BASELINE", data)
        rig.injected += 2
    rig.hear(0.5)
    rig.alive("map", "planner", "verifier")
    rig.serve()
    return "neither pieces nor a false digest become a route"


@row("requests cross: 100 a second", "LCM bursts", ["verifier:slow"])
def many_requests(rig):
    rig.set_up("searcher")
    for _ in range(200):
        rig.ask()
        rig.hear(0.01)
        rig.injected += 1
    rig.await_served()
    return "the last one is served"
