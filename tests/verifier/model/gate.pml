/* The gate's logic with everything around it free to misbehave: an abstract
 * model for Spin (Holzmann 1997) of the rules of docs/gate.md.
 *
 * A route is a head (from the start to a middle cell, one of two) and a tail
 * (from a middle cell to the goal); it holds together if tail % 2 == head. The
 * costs are chosen so that a map update blocks, raises and lowers routes. The
 * bus is a register per channel, read at any time: that is loss, delay and
 * repetition in order. Advice is any message at any time. Each rule can be
 * taken out by -DM_<rule>; check_model.sh lists what must be noticed. */

#define BLOCKED 20

byte head_cost[4] = { 1, 2,  1, 1 };                    /* map * 2 + head */
byte tail_cost[8] = { 5, 2, 3, BLOCKED,  4, BLOCKED, 6, 2 }; /* map * 4 + tail */

#define COST(m, h, t) (head_cost[(m) * 2 + (h)] + tail_cost[(m) * 4 + (t)])
#define REST(m, t) (tail_cost[(m) * 4 + (t)])
#define FEASIBLE(m, h, t) (COST(m, h, t) < BLOCKED && (t) % 2 == (h))

#define NONE 0
#define BASELINE 1
#define CANDIDATE 2
#define HOLD 3
#define HAS_ROUTE (d_mode == BASELINE || d_mode == CANDIDATE)

/* ---- Rules that can be taken out, or made too strict. ---- */
#ifdef M_REQUEST
#define R_REQUEST true
#else
#define R_REQUEST (p_rq == g_rq)
#endif
#ifdef M_MAP
#define R_MAP true
#else
#define R_MAP (p_m == g_m)
#endif
#ifdef M_BASELINE
#define R_BASELINE true
#else
#define R_BASELINE (p_bh == g_bh && p_bt == g_bt)
#endif
#ifdef M_BASELINE_VALID
#define R_BASELINE_VALID (g_b)
#else
#define R_BASELINE_VALID (g_b && g_valid)
#endif
#ifdef M_ANCHOR
#define R_ANCHOR true
#else
#define R_ANCHOR (p_anchor == 0 || p_named)
#endif
#ifdef M_LATE
#define R_LATE true
#else
#define R_LATE (p_anchor >= place)
#endif
#ifdef M_START
#define R_START true
#else
#define R_START (p_anchor == 0 || p_h == d_h)
#endif
#ifdef M_GOAL
#define R_GOAL true
#else
#define R_GOAL (p_goal == g_rq)
#endif
#ifdef M_FEASIBLE
#define R_FEASIBLE true
#else
#define R_FEASIBLE (FEASIBLE(g_m, p_h, p_t))
#endif
#ifdef M_CHEAPER
#define R_CHEAPER true
#else
#define R_CHEAPER (COST(g_m, p_h, p_t) < COST(g_m, g_bh, g_bt))
#endif
#ifdef M_BEST
#define R_BEST true
#else
#define R_BEST (p_anchor == 0 && COST(g_m, p_h, p_t) < COST(g_m, d_h, d_t) || \
                p_anchor == 1 && REST(g_m, p_t) < REST(g_m, d_t))
#endif
#ifdef M_ONCE /* too strict */
#define R_ONCE (d_mode == BASELINE)
#else
#define R_ONCE true
#endif
#ifdef M_WAIT /* too strict: the baseline waits for an advisor */
#define R_DEPLOY_AT_ONCE (heard_advice)
#else
#define R_DEPLOY_AT_ONCE true
#endif
#ifdef M_UNCHECKED
#define R_CHECKED true
#else
#define R_CHECKED (g_valid)
#endif
#ifdef M_DEARER
#define R_NOT_DEARER true
#else
#define R_NOT_DEARER (COST(g_m, g_bh, g_bt) < COST(g_m, d_h, d_t))
#endif
#ifdef M_REPLACED
#define R_NOT_REPLACED true
#else
#define R_NOT_REPLACED (b_rq > g_rq)
#endif

/* ---- The world: what is true, and what is on the bus. ---- */
bit w_map = 0;
byte asked = 1;                  /* PLAN_REQUEST */
bit b_said = 0;                  /* BASELINE */
byte b_rq = 0;
bit b_m, b_h;
byte b_t;

/* ---- The gate's state; kill -9 sets it back. ---- */
bit g_has_map = 0, g_m;
byte g_rq = 0;
bit g_b = 0, g_bh, g_valid;      /* baseline held, on which the key is */
bit g_bm;                        /* the map its message names */
byte g_bt;
byte d_mode = NONE, d_t, d_goal, d_rq;
bit d_h, d_m;
bit place = 0;                   /* the robot has passed the head */
bit heard_advice = 0;

/* ---- What is on the bus and not taken yet. ---- */
#define MAP_WAITS (!g_has_map || g_m != w_map)
#define REQUEST_WAITS (asked > g_rq)
#define REQUEST_OF_PLANNER_WAITS (b_said && b_rq != g_rq && R_NOT_REPLACED)
#define BASELINE_WAITS                                         \
  (b_said && b_rq == g_rq && g_has_map && b_m == g_m &&        \
   !(g_b && g_bm == b_m && g_bh == b_h && g_bt == b_t))
#define QUESTION_WAITS (!b_said || b_rq != asked || b_m != w_map)

/* ---- Ghosts, for the invariants only. ---- */
bit moved = 0;                   /* the head that the robot has driven */
bit late_upgrade = 0;

inline CheckInvariants() {
  /* 1 */ assert(!(g_has_map && g_b && FEASIBLE(g_m, g_bh, g_bt)) || HAS_ROUTE);
  /* 2 */ assert(!HAS_ROUTE || (d_m == g_m && d_rq == g_rq && d_goal == d_rq &&
                                FEASIBLE(d_m, d_h, d_t)));
  /* 3 */ assert(!(HAS_ROUTE && g_b && FEASIBLE(g_m, g_bh, g_bt)) ||
                 COST(g_m, d_h, d_t) <= COST(g_m, g_bh, g_bt));
  /* 8 */ assert(d_mode != BASELINE || FEASIBLE(d_m, d_h, d_t));
  assert(!late_upgrade)
}

inline Deploy(mode, h, t, goal) {
  /* 4 */ assert(!(HAS_ROUTE && d_m == g_m && d_rq == g_rq) ||
                 ((mode == BASELINE || mode == CANDIDATE) &&
                  COST(g_m, h, t) < COST(g_m, d_h, d_t)));
  if
  :: (mode == BASELINE || mode == CANDIDATE) && HAS_ROUTE && h == d_h -> skip
  :: else -> place = 0; moved = 0
  fi;
  d_mode = mode; d_h = h; d_t = t; d_goal = goal; d_m = g_m; d_rq = g_rq
}

inline DropRoute(mode) {
  d_mode = mode; d_h = 0; d_t = 0; d_goal = 0; d_m = g_m; d_rq = g_rq;
  place = 0; moved = 0
}

inline TakeRequest(rq) {
  assert(rq > g_rq);             /* a replaced request never comes back */
  g_rq = rq; g_b = 0; g_bh = 0; g_bt = 0; g_bm = 0; g_valid = 0;
  DropRoute(NONE)
}

proctype MapLane() {
end:
  do
  :: atomic { MAP_WAITS ->
       g_has_map = 1; g_m = w_map;
#ifndef M_RECHECK_BASELINE
       g_valid = (g_b && FEASIBLE(g_m, g_bh, g_bt));
#endif
#ifdef M_RECHECK_DEPLOYED
       d_m = g_m;
#else
       if
       :: HAS_ROUTE && !g_valid && FEASIBLE(g_m, d_h, d_t) -> d_m = g_m
       :: HAS_ROUTE && !g_valid && !FEASIBLE(g_m, d_h, d_t) -> DropRoute(HOLD)
       :: HAS_ROUTE && g_valid && FEASIBLE(g_m, d_h, d_t) &&
          COST(g_m, d_h, d_t) <= COST(g_m, g_bh, g_bt) -> d_m = g_m
       :: HAS_ROUTE && g_valid && !(FEASIBLE(g_m, d_h, d_t) &&
          COST(g_m, d_h, d_t) <= COST(g_m, g_bh, g_bt)) ->
            Deploy(BASELINE, g_bh, g_bt, g_rq)
       :: !HAS_ROUTE && g_valid -> Deploy(BASELINE, g_bh, g_bt, g_rq)
       :: else -> d_m = g_m
       fi;
#endif
       CheckInvariants() }
  od
}

proctype RequestLane() {
end:
  do
  :: atomic { REQUEST_WAITS -> TakeRequest(asked); CheckInvariants() }
  od
}

proctype BaselineLane() {
end:
  do
  :: atomic { REQUEST_OF_PLANNER_WAITS ->
       TakeRequest(b_rq); CheckInvariants() }
  :: atomic { BASELINE_WAITS && R_DEPLOY_AT_ONCE ->
       g_b = 1; g_bm = b_m; g_bh = b_h; g_bt = b_t;
       g_valid = FEASIBLE(g_m, g_bh, g_bt);
       if
       :: R_CHECKED && (!HAS_ROUTE || R_NOT_DEARER) ->
            Deploy(BASELINE, g_bh, g_bt, g_rq)
       :: !R_CHECKED && !HAS_ROUTE -> DropRoute(HOLD)
       :: else -> skip
       fi;
       CheckInvariants() }
  od
}

/* What must be accepted, told without the rules above (invariant 9). */
#define GOOD (g_has_map && g_b && FEASIBLE(g_m, g_bh, g_bt) && p_rq == g_rq && \
              p_m == g_m && p_bh == g_bh && p_bt == g_bt && p_goal == g_rq && \
              FEASIBLE(g_m, p_h, p_t) && \
              (p_anchor == 0 && !moved || p_anchor == 1 && p_named && p_h == d_h) && \
              COST(g_m, p_h, p_t) < COST(g_m, d_h, d_t))

/* Any message at any time: a crash, a freeze and silence are among them. */
proctype AdviceLane() {
  byte p_rq, p_t, p_bt, p_goal;
  bit p_m, p_bh, p_anchor, p_named, p_h;
end:
  do
  :: atomic { g_rq > 0 && g_has_map && g_b ->
       heard_advice = 1;
       select(p_rq : 1..2); select(p_m : 0..1);
       if :: p_bh = g_bh; p_bt = g_bt :: p_bh = 1 - g_bh; p_bt = 1 - g_bh fi;
       select(p_anchor : 0..1); select(p_named : 0..1);
       select(p_h : 0..1); select(p_t : 0..3);
       if :: p_goal = g_rq :: p_goal = 3 - g_rq fi;
       if
       :: HAS_ROUTE && R_REQUEST && R_MAP && R_BASELINE && R_BASELINE_VALID &&
          R_ANCHOR && R_LATE && R_START && R_GOAL && R_FEASIBLE &&
          R_CHEAPER && R_BEST && R_ONCE ->
            /* 5 */ assert(p_rq == g_rq && p_m == g_m && p_bh == g_bh &&
                           p_bt == g_bt && (p_anchor == 0 || p_named));
            assert(g_b && FEASIBLE(g_m, g_bh, g_bt));
            late_upgrade = moved && p_anchor == 0;
            if
            :: p_anchor == 0 -> Deploy(CANDIDATE, p_h, p_t, p_goal)
            :: else -> Deploy(CANDIDATE, d_h, p_t, p_goal)
            fi
       :: else -> /* 9 */ assert(!(HAS_ROUTE && GOOD))
       fi;
       CheckInvariants();
       p_rq = 0; p_m = 0; p_bh = 0; p_bt = 0; p_anchor = 0; p_named = 0;
       p_h = 0; p_t = 0; p_goal = 0 }
  od
}

/* Repeats what it has for the request and map that it knows of; now and then a
 * route that is wrong, or another one for the same question. */
proctype Planner() {
  byte others = 0;
end:
  do
  :: atomic { QUESTION_WAITS || others < 1 ->
       if
       :: b_said && b_rq == asked && b_m == w_map -> others++
       :: else -> skip
       fi;
       b_said = 1; b_rq = asked; b_m = w_map;
       select(b_h : 0..1); select(b_t : 0..3) }
  od
}

proctype World() {
  bit driven = 0, killed = 0;
  do
  :: atomic { w_map == 0 -> w_map = 1 }
  :: atomic { asked == 1 -> asked = 2 }
  :: atomic { HAS_ROUTE && !driven -> driven = 1; place = 1; moved = 1 }
  :: atomic { !killed -> killed = 1;
       g_has_map = 0; g_m = 0; g_rq = 0; g_b = 0; g_bh = 0; g_bt = 0;
       g_bm = 0; g_valid = 0; d_mode = NONE; d_h = 0; d_t = 0; d_goal = 0;
       d_m = 0; d_rq = 0; place = 0; moved = 0; heard_advice = 0 }
  :: break
  od
}

/* Nobody waits for an advisor: when each has taken what is on the bus, the
 * baseline is answered by a route for the request and map in force. */
proctype AtRest() {
end:
  do
  :: atomic { !(MAP_WAITS || REQUEST_WAITS || REQUEST_OF_PLANNER_WAITS ||
                QUESTION_WAITS || BASELINE_WAITS && R_DEPLOY_AT_ONCE) ->
       assert(!FEASIBLE(w_map, b_h, b_t) ||
              HAS_ROUTE && d_rq == asked && d_m == w_map) }
  od
}

init {
  atomic {
    run MapLane(); run RequestLane(); run BaselineLane(); run AdviceLane();
    run Planner(); run World(); run AtRest()
  }
}
