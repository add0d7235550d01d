--------------------------- MODULE NoteArrivalRows ---------------------------
(* Phase 7: an axis that has arrived. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

ASSUME
  \A changed \in BOOLEAN, driven \in 0..2, progress \in -1..1 :
    LET a == NoteArrival([setpoint_changed |-> changed, stall_driven_ticks |-> driven, since_stall_mark |-> progress])
    IN PrintT(<< changed, driven, progress, a.setpoint_changed, a.stall_driven_ticks, a.since_stall_mark >>)
==============================================================================
