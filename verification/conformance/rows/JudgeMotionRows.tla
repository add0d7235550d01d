--------------------------- MODULE JudgeMotionRows ---------------------------
(* Phase 4: what the motion means. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS max_delta_counts, reverse_counts, drift_counts, settle_ticks, stall_ticks

Bounds == [ max_delta_counts |-> max_delta_counts, reverse_counts |-> reverse_counts, drift_counts |-> drift_counts,
            settle_ticks |-> settle_ticks, stall_ticks |-> stall_ticks ]

ASSUME
  \A delta \in -3..3, ticks \in 0..2, driven \in Directions, reverse \in Directions, back \in
     -2..2, state \in AxisStates, undriven \in 0..settle_ticks, drift \in -2..2, stalled
     \in 0..stall_ticks :
    LET a == [ delta_counts |-> delta, ticks_since_frame |-> ticks, driven_direction |-> driven,
               reverse_direction |-> reverse, since_reverse_mark |-> back, state |-> state,
               undriven_ticks |-> undriven, since_drift_mark |-> drift, stall_driven_ticks |-> stalled ]
        fault == JudgeMotion(Bounds, a)
    IN PrintT(<< delta, ticks, driven, reverse, back, state, undriven, drift, stalled, fault >>)
==============================================================================
