--------------------------- MODULE MarkReverseRows ---------------------------
(* Phase 4: the mark of the farthest point. The records hold what it may read
   and nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

ASSUME
  \A direction \in Directions, since \in -3..3 :
    LET a == AdvanceReverseMark([reverse_direction |-> direction, since_reverse_mark |-> since])
    IN PrintT(<< direction, since, a.since_reverse_mark >>)
==============================================================================
