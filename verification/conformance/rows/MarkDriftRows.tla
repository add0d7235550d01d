---------------------------- MODULE MarkDriftRows ----------------------------
(* Phase 4: the mark of rest. The records hold what it may read and nothing
   else: TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS settle_ticks

ASSUME
  \A driven \in Directions, undriven \in 0..settle_ticks, state \in AxisStates, since \in -2..2 :
    LET k      == [ settle_ticks |-> settle_ticks ]
        before == [ driven_direction |-> driven, undriven_ticks |-> undriven, state |-> state,
                    since_drift_mark |-> since ]
        a == AdvanceDriftMark(k, before)
    IN PrintT(<< driven, undriven, state, since, a.since_drift_mark >>)
==============================================================================
