---------------------------- MODULE EnterModeRows ----------------------------
(* A change of mode. The records hold what it may read and nothing else: TLC
   fails at any other field. *)
EXTENDS System, Axis, TLC

ASSUME
  \A to \in Modes \ {"INIT"}, state \in AxisStates : \A phase \in (IF state = "HOMING" THEN
     Phases \ {"NONE"} ELSE {"NONE"}), driven \in 0..1, changed \in BOOLEAN, press \in
     -1..1 :
    LET system == Enter([mode |-> <<"unread">>, pedal_armed |-> TRUE, pedal_pressed_ticks |-> 1,
                         pedal_released_ticks |-> 1], to)
        before == [ state |-> state, homing_phase |-> phase, stall_driven_ticks |-> driven,
                    setpoint_changed |-> changed, press_travel_counts |-> press, lease_ticks |-> 1,
                    drive |-> 1, setpoint_counts |-> 1 ]
        a == FollowMode("ANOTHER", to, before)
    IN PrintT(<< to, state, phase, driven, changed, press, system.mode, system.pedal_armed,
                 system.pedal_pressed_ticks, system.pedal_released_ticks, a.state,
                 a.homing_phase, a.setpoint_changed, a.press_travel_counts,
                 a.lease_ticks, a.drive, a.setpoint_counts >>)
==============================================================================
