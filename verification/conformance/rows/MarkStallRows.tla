---------------------------- MODULE MarkStallRows ----------------------------
(* Phase 4: the stall count and its mark. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS settle_ticks, stall_min_counts

ASSUME
  \A steered \in Directions, undriven \in 0..settle_ticks, direction \in Directions, since \in -3..3, driven \in 0..2,
     changed \in BOOLEAN :
    LET k      == [ settle_ticks |-> settle_ticks, stall_min_counts |-> stall_min_counts ]
        before == [ driven_direction |-> steered, undriven_ticks |-> undriven, stall_direction |-> direction,
                    since_stall_mark |-> since, stall_driven_ticks |-> driven, setpoint_changed |-> changed ]
        a == AdvanceStallMark(k, before)
    IN PrintT(<< steered, undriven, direction, since, driven, changed, a.since_stall_mark, a.stall_driven_ticks,
                 a.setpoint_changed >>)
==============================================================================
