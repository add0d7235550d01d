-------------------------- MODULE CountUndrivenRows --------------------------
(* Phase 4: ticks since the last driven one. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS settle_ticks

ASSUME
  \A driven \in Directions, since \in 0..2, undriven \in 0..settle_ticks :
    LET before == [driven_direction |-> driven, ticks_since_frame |-> since, undriven_ticks |-> undriven]
        a == CountUndriven([settle_ticks |-> settle_ticks], before)
    IN PrintT(<< driven, since, undriven, a.undriven_ticks >>)
==============================================================================
