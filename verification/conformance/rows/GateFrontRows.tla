---------------------------- MODULE GateFrontRows ----------------------------
(* Phase 7: the gate up to the wish. With a switch that is open, a position in
   the middle and no bound reached, the limits of GateLimitsRows are all
   passed. *)
EXTENDS Axis, TLC

ASSUME
  \A mode \in Modes, pedal \in PedalStates, estop \in BOOLEAN, valid \in BOOLEAN, state \in
     AxisStates, lease \in 0..1, direction \in Directions, drive \in 0..1 :
    LET s == [mode |-> mode, pedal |-> pedal, estop |-> estop]
        a == [ card_valid |-> valid, state |-> state, lease_ticks |-> lease, switch_triggered |-> FALSE,
               homed |-> TRUE, position_counts |-> 0 ]
        k == [max_counts |-> 9, min_counts |-> -9, coast_counts |-> 1, max_drive |-> 9]
        gate == Gate(k, s, a, [direction |-> direction, drive |-> drive])
    IN PrintT(<< mode, pedal, estop, valid, state, lease, direction, drive, gate >>)
==============================================================================
