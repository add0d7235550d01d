-------------------------- MODULE JudgeDeclareRows ---------------------------
(* Phase 6: SET_HOME and RESTORE. The records hold what it may read and nothing
   else: TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS reach

ASSUME
  \A kind \in {"SET_HOME", "RESTORE"}, mode \in Modes, pedal \in PedalStates, state \in AxisStates, valid \in BOOLEAN :
  \A undriven \in 0..2, since \in 0..2, delta \in -1..1, target \in -5..5 :
    LET a == [state |-> state, card_valid |-> valid, undriven_ticks |-> undriven, ticks_since_frame |-> since,
              delta_counts |-> delta]
        k == [min_counts |-> -reach, max_counts |-> reach]
        request == [kind |-> kind, target |-> target]
        verdict == JudgeAxis([unread |-> 0], k, [mode |-> mode, pedal |-> pedal], a, request)
    IN PrintT(<< kind, mode, pedal, state, valid, undriven, since, delta, target, verdict >>)
==============================================================================
