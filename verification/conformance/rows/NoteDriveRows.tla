---------------------------- MODULE NoteDriveRows ----------------------------
(* Phase 7: the marks of a driven axis. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS settle_ticks, stall_ticks

ASSUME
  \A direction \in {"INCREASING", "DECREASING"}, undriven \in 0..settle_ticks, reverse \in
     Directions, back \in -1..1, stall \in Directions, progress \in -1..1, driven \in
     0..stall_ticks :
    LET before == [ undriven_ticks |-> undriven, reverse_direction |-> reverse, since_reverse_mark |-> back,
                    stall_direction |-> stall, since_stall_mark |-> progress, stall_driven_ticks |-> driven,
                    driven_direction |-> <<"unread">> ]
        a == NoteDrive([settle_ticks |-> settle_ticks, stall_ticks |-> stall_ticks], before, direction)
    IN PrintT(<< direction, undriven, reverse, back, stall, progress, driven, a.reverse_direction,
                 a.since_reverse_mark, a.stall_direction, a.since_stall_mark,
                 a.stall_driven_ticks, a.driven_direction >>)
==============================================================================
