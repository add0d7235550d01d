---------------------------- MODULE JudgeDoorRows ----------------------------
(* Phase 6: what every request meets first. *)
EXTENDS System, TLC

ASSUME
  \A door \in Doors, kind \in Kinds \union {"NONSENSE"}, there \in BOOLEAN :
    LET verdict == JudgeDoor([door |-> door, kind |-> kind, axis |-> 4], IF there THEN {4} ELSE {})
    IN PrintT(<< door, kind, there, verdict >>)
==============================================================================
