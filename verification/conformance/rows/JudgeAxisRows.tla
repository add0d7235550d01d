---------------------------- MODULE JudgeAxisRows ----------------------------
(* Phase 6: requests that name an axis. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

ASSUME
  \A kind \in {"DISABLE", "ENABLE", "CLEAR_FAULT", "HOME"}, mode \in Modes, pedal \in
     PedalStates, state \in AxisStates, valid \in BOOLEAN, now \in BOOLEAN, side \in Sides :
    LET s == [mode |-> mode, pedal |-> pedal]
        a == [state |-> state, card_valid |-> valid, fault_now |-> now]
        verdict == JudgeAxis([unread |-> 0], [limit_side |-> side], s, a, [kind |-> kind])
    IN PrintT(<< kind, mode, pedal, state, valid, now, side, verdict >>)
==============================================================================
