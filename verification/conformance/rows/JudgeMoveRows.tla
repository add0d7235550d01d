---------------------------- MODULE JudgeMoveRows ----------------------------
(* Phase 6: MOVE. The records hold what it may read and nothing else: TLC fails
   at any other field. *)
EXTENDS Axis, TLC

CONSTANTS lease_max_ticks, reach, coast_counts, max_drive, unhomed_max_drive, unhomed_travel_counts

Bounds == [ min_counts |-> -reach, max_counts |-> reach, coast_counts |-> coast_counts,
            max_drive |-> max_drive, unhomed_max_drive |-> unhomed_max_drive,
            unhomed_travel_counts |-> unhomed_travel_counts ]

ASSUME
  \A mode \in Modes, state \in AxisStates, homed \in BOOLEAN, lease \in 0..2, drive \in 0..3,
     position \in -1..1, press \in -1..1, target \in -5..5 :
    LET a == [state |-> state, homed |-> homed, position_counts |-> position, press_travel_counts |-> press]
        request == [kind |-> "MOVE", lease |-> lease, drive |-> drive, target |-> target]
        verdict == JudgeAxis([lease_max_ticks |-> lease_max_ticks], Bounds, [mode |-> mode], a, request)
    IN PrintT(<< mode, state, homed, lease, drive, position, press, target, verdict >>)
==============================================================================
