---------------------------- MODULE ObserveBusRows ----------------------------
(* Phase 2: whether the bus says anything, by the frames of two cards. The records
   hold what it may read and nothing else: TLC fails at any other field. *)
EXTENDS Kernel

CONSTANTS bad_frame_limit

ASSUME
  \A first \in Frames, second \in Frames, first_seen \in BOOLEAN, second_seen \in BOOLEAN,
     bus \in 0..bad_frame_limit :
    LET axes == << [card_seen |-> first_seen], [card_seen |-> second_seen] >>
        readings == << [frame |-> first], [frame |-> second] >>
        any_valid == AnyValid(axes, [readings |-> readings])
        s == ObserveBus([bad_frame_limit |-> bad_frame_limit], [bus_bad_ticks |-> bus], [any_valid |-> any_valid])
    IN PrintT(<< first, second, first_seen, second_seen, bus, s.bus_bad_ticks >>)
==============================================================================
