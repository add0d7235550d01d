--------------------------- MODULE ReadSwitchRows ----------------------------
(* Phase 4: what the switch says. The records hold what it may read and nothing
   else: TLC fails at any other field. *)
EXTENDS Axis, TLC

ASSUME
  \A side \in Sides, valid \in BOOLEAN, switch \in BOOLEAN :
    LET triggered == ReadSwitch([limit_side |-> side], [card_valid |-> valid], [switch |-> switch])
    IN PrintT(<< side, valid, switch, triggered >>)
==============================================================================
