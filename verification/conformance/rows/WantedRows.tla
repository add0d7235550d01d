----------------------------- MODULE WantedRows ------------------------------
(* Phase 7: the wish. The records hold what it may read and nothing else: TLC
   fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS deadband_counts, home_drive

ASSUME
  \A state \in AxisStates, phase \in Phases, side \in Sides, distance \in -3..3, drive \in 0..2 :
    LET a == [state |-> state, homing_phase |-> phase, setpoint_counts |-> distance, position_counts |-> 0, drive |-> drive]
        wanted == WantedCommand([limit_side |-> side, deadband_counts |-> deadband_counts, home_drive |-> home_drive], a)
    IN PrintT(<< state, phase, side, distance, drive, wanted.direction, wanted.drive >>)
==============================================================================
