-------------------------------- MODULE Homing --------------------------------
(* Phase 4 of an axis that homes, and phase 4 of an axis as a whole. It waits,
   undriven, until the switch has read one way; backs off if that was triggered;
   approaches; backs off; approaches again slowly; waits for rest; compares the edges. *)
EXTENDS Axis

EnterPhase(a, phase, mark) == [a EXCEPT !.homing_phase = phase, !.homing_mark = mark]

(* How far it stands from the mark on the open side. *)
CountsClear(k, a) == Along(AwayFromSwitch(k), a.raw - a.homing_mark)

IsClear(k, a) == ReadsOpen(k, a) /\ CountsClear(k, a) >= k.home_clear_counts

(* An edge is where the first reading of the run that triggered it was. *)
TakeEdges(k, a) ==
  CASE a.homing_phase = "WAIT" ->
         IF ReadsTriggered(k, a) THEN EnterPhase(a, "BACK_OFF", a.raw)
         ELSE IF ReadsOpen(k, a) THEN EnterPhase(a, "APPROACH", a.raw) ELSE a
    [] a.homing_phase = "BACK_OFF" ->
         IF IsClear(k, a) THEN EnterPhase(a, "APPROACH", a.raw) ELSE a
    [] a.homing_phase = "APPROACH" ->
         IF ReadsTriggered(k, a)
         THEN EnterPhase([a EXCEPT !.first_edge = a.switch_raw], "BACK_OFF_AGAIN", a.switch_raw) ELSE a
    [] a.homing_phase = "BACK_OFF_AGAIN" ->
         IF IsClear(k, a) THEN EnterPhase(a, "APPROACH_SLOWLY", a.raw) ELSE a
    [] a.homing_phase = "APPROACH_SLOWLY" ->
         IF ReadsTriggered(k, a)
         THEN EnterPhase([a EXCEPT !.second_edge = a.switch_raw], "REST", a.switch_raw) ELSE a
    [] a.homing_phase = "REST" ->
         IF IsAtRest(k, a) /\ ReadsOpen(k, a) THEN EnterPhase(a, "APPROACH_SLOWLY", a.raw) ELSE a
    [] OTHER -> a

MayCompare(k, a) == a.homing_phase = "REST" /\ IsAtRest(k, a) /\ ReadsTriggered(k, a)

(* The second edge agrees with the first, and the axis rests where it can have coasted to. *)
EdgesAgree(k, a) ==
  /\ Magnitude(a.second_edge - a.first_edge) <= k.home_tolerance_counts
  /\ Magnitude(a.raw - a.second_edge) <= k.home_tolerance_counts + k.coast_counts

(* The reference is the edge of the slow approach. *)
Homed(k, a) ==
  [EnterPhase(a, "NONE", a.raw) EXCEPT
     !.state = "ENABLED", !.homed = "SWITCH",
     !.position_counts = a.raw - a.second_edge + k.home_offset_counts]

JudgeHoming(k, a) ==
  IF MayCompare(k, a) /\ ~EdgesAgree(k, a) THEN "SWITCH"
  ELSE IF ~HomingTravelLeft(k, a) /\ WantedHoming(k, a) # NoDrive THEN "HOMING_TRAVEL"
  ELSE IF a.homing_ticks >= k.home_timeout_ticks THEN "HOMING_TIMEOUT"
  ELSE "NONE"

(* Only valid readings make edges; time passes without them, too. *)
ObserveHoming(k, observed) ==
  LET counted == [observed.axis EXCEPT !.homing_ticks = CountUp(@, k.home_timeout_ticks)]
      edged   == IF counted.card_valid THEN TakeEdges(k, counted) ELSE counted
      fault   == JudgeHoming(k, edged)
  IN  IF observed.fault # "NONE" \/ observed.axis.state # "HOMING" THEN observed
      ELSE IF fault # "NONE" THEN [axis |-> edged, fault |-> fault]
      ELSE [axis |-> IF MayCompare(k, edged) THEN Homed(k, edged) ELSE edged, fault |-> "NONE"]

-------------------------------------------------------------------------------
(* Phase 4, whole. *)
ObserveAxis(s, c, k, a, reading) ==
  LET observed == ObserveHoming(k, Observe1(s, c, k, a, reading))
      judged   == IF observed.fault = "NONE" THEN observed.axis ELSE Faulted(observed.axis, observed.fault)
  IN  JudgeRunaway(c, k, judged)
===============================================================================
