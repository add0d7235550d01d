------------------------- MODULE ObserveMissingRows --------------------------
(* Phase 4: no valid frame. The records hold what it may read and nothing else:
   TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS bad_frame_limit

ASSUME
  \A bad \in 0..bad_frame_limit, seen \in BOOLEAN :
    LET missing == ObserveMissing([bad_frame_limit |-> bad_frame_limit], [bad_frames |-> bad, card_seen |-> seen])
    IN PrintT(<< bad, seen, missing.axis.card_seen, missing.fault >>)
==============================================================================
