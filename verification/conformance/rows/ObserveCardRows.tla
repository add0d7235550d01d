--------------------------- MODULE ObserveCardRows ---------------------------
(* Phase 2: one card. The records hold what it may read and nothing else: TLC
   fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS bad_frame_limit

ASSUME
  \A frame \in Frames, seen \in BOOLEAN, valid \in BOOLEAN, bad \in 0..bad_frame_limit, since \in 0..bad_frame_limit :
    LET before == [card_seen |-> seen, card_valid |-> valid, bad_frames |-> bad, ticks_since_frame |-> since]
        a == ObserveCard([bad_frame_limit |-> bad_frame_limit], before, frame)
    IN PrintT(<< frame, seen, valid, bad, since, a.card_valid, a.bad_frames, a.ticks_since_frame >>)
==============================================================================
