------------------------------ MODULE FaultRows ------------------------------
(* Phase 4: what a fault does. The records hold what it may read and nothing
   else: TLC fails at any other field. *)
EXTENDS Axis, TLC

(* A fault that is kept is not looked at. *)
Before == <<"before">>
Kept(a) == IF a.fault = Before THEN "NONE" ELSE "CHANGED"

ASSUME
  \A fault \in Faults \ {"NONE"}, state \in AxisStates : \A phase \in (IF state = "HOMING" THEN
     Phases \ {"NONE"} ELSE {"NONE"}), homed \in BOOLEAN, driven \in 0..1, changed \in
     BOOLEAN :
    LET before == [ state |-> state, fault |-> Before, fault_now |-> FALSE, homing_phase |-> phase, homed |-> homed,
                    stall_driven_ticks |-> driven, setpoint_changed |-> changed ]
        a == Faulted(before, fault)
    IN PrintT(<< fault, state, phase, homed, driven, changed, a.state, IF state = "FAULTED" THEN Kept(a)
                 ELSE a.fault, a.homing_phase, a.homed, a.setpoint_changed, a.fault_now >>)
==============================================================================
