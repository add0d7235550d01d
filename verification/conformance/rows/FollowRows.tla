----------------------------- MODULE FollowRows ------------------------------
(* Phase 4: a new reading of the counter. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

ASSUME
  \A seen \in BOOLEAN, moved \in -2..2, position \in -1..1, press \in -1..1, stall \in -1..1,
     reverse \in -1..1, drift \in -1..1, homing \in -1..1 :
    LET before == [ card_seen |-> seen, ticks_since_frame |-> 0, delta_counts |-> <<"unread">>,
                    position_counts |-> position, press_travel_counts |-> press, since_stall_mark |-> stall,
                    since_reverse_mark |-> reverse, since_drift_mark |-> drift, since_homing_mark |-> homing ]
        a == Follow(before, moved)
    IN PrintT(<< seen, moved, position, press, stall, reverse, drift, homing, a.card_seen,
                 a.delta_counts, a.position_counts, a.press_travel_counts,
                 a.since_stall_mark, a.since_reverse_mark, a.since_drift_mark,
                 a.since_homing_mark >>)
==============================================================================
