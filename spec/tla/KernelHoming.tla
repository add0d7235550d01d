----------------------------- MODULE KernelHoming -----------------------------
(* Homing. The switch bounces, or reads wrong in any tick; the counter sticks, moves as
   it is driven, and slips when it is not; frames get lost; DISABLE, ENABLE and HOME
   come in one tick. *)
EXTENDS KernelOne

HomingAxis ==
  [WideAxis EXCEPT !.limit_side = "LOWER", !.home_offset_counts = -1, !.home_drive = 2,
                   !.unhomed_max_drive = 2, !.noise_counts = 0]

(* The switch closes at 0. *)
HomingBody == [low |-> -1, high |-> 3, closes |-> 0, opens |-> 0]

Moves ==
  {m \in (IF axis.driven_direction # "NONE" THEN {0, Sense(axis.driven_direction)}
          ELSE IF axis.homing_phase = "REST" THEN {-1, 0, 1} ELSE {0}) : Inside(m)}

Events ==
  {[m |-> m, reading |-> Reading(plant.at + m, switch)] : m \in Moves, switch \in BOOLEAN}
  \union {[m |-> 0, reading |-> Lost]}

Wishes ==
  IF axis.state = "HOMING" THEN {<<>>, <<Ask("DISABLE"), Ask("ENABLE"), Ask("HOME")>>}
  ELSE {<<Ask("ENABLE"), Ask("HOME")>>}

(* What the inputs have shown since HOME: how much of the order, a run of readings of the
   switch with the counter at its first, the two edges, and a run at rest. *)
Nothing == [shown |-> 0, triggered |-> FALSE, ticks |-> 0, raw |-> 0, e1 |-> 0, e2 |-> 0,
            driven |-> FALSE, rest |-> RunAt(0)]

Counted ==
  IF ~Read1.valid THEN [seen EXCEPT !.rest = RunAt(seen.rest.low)]
  ELSE LET same   == seen.ticks > 0 /\ seen.triggered = Read1.switch
           rested == IF seen.driven THEN RunAt(Read1.raw)
                     ELSE Prolonged(seen.rest, Read1.raw, k.noise_counts, k.rest_ticks)
       IN  [seen EXCEPT !.triggered = Read1.switch, !.rest = rested,
                        !.ticks = IF same THEN CountUp(@, k.switch_debounce_ticks) ELSE 1,
                        !.raw = IF same THEN @ ELSE Read1.raw]

Closed(w) == w.triggered /\ w.ticks = k.switch_debounce_ticks
Open(w)   == ~w.triggered /\ w.ticks = k.switch_debounce_ticks
Rests(w)  == Read1.valid /\ w.rest.ticks >= k.rest_ticks
Clear(w)  == Along(AwayFromSwitch(k), Read1.raw - w.e1) >= k.home_clear_counts

Shown(w) ==
  CASE ~Read1.valid -> w
    [] w.shown = 0 /\ Open(w)              -> [w EXCEPT !.shown = 1]
    [] w.shown = 1 /\ Closed(w)            -> [w EXCEPT !.shown = 2, !.e1 = w.raw]
    [] w.shown = 2 /\ Open(w) /\ Clear(w)  -> [w EXCEPT !.shown = 3]
    [] w.shown = 3 /\ Closed(w)            -> [w EXCEPT !.shown = 4, !.e2 = w.raw]
    [] w.shown = 4 /\ Rests(w) /\ Open(w)  -> [w EXCEPT !.shown = 3, !.e2 = 0]
    [] OTHER -> w

(* Too fast since it was open and clear: that approach counts for nothing. *)
Witnessed ==
  LET w    == Shown(Counted)
      fast == w.shown >= 3 /\ io'.command.drive > k.home_slow_drive
  IN  IF axis'.state # "HOMING" \/ Accepted({"HOME"}) THEN Nothing
      ELSE [w EXCEPT !.driven = Driven, !.shown = IF fast THEN 0 ELSE @,
                     !.raw = IF w.triggered /\ w.shown \in {1, 3} THEN @ ELSE 0,
                     !.rest = IF Driven THEN RunAt(0) ELSE @]

Step(in, m) == Tock(in, m) /\ seen' = Witnessed

AnyTick == Met("AnyTick") /\ system.mode = "MOTION" /\ \E event \in Events, wishes \in Wishes :
  Step(Input("CLOSED", event.reading, <<Beat>> \o wishes), event.m)

ReleaseTick == system.mode = "MOTION" /\ Met("ReleaseTick") /\
  Step(Input("OPEN", Reading(plant.at, plant.at <= body.closes), <<Beat>>), 0)

(* Back into MOTION, whatever has happened, with a switch that reads true. *)
Remedy ==
  IF system.mode = "LOCKED" THEN <<Ask("RESET")>>
  ELSE <<Ask("CLEAR_FAULT"), Ask("ENABLE")>>

BackTick == system.mode # "MOTION" /\ Met("BackTick") /\
  Step(Input(IF axis.state = "FAULTED" THEN "OPEN" ELSE Held,
             Reading(plant.at, plant.at <= body.closes), <<Beat>> \o Remedy), 0)

Init ==
  /\ \E at \in {0, 2} : BeginIn(After(PowerOn, IntoMotion(at, <<Ask("ENABLE")>>)), at)
  /\ seen = Nothing

Next == AnyTick \/ ReleaseTick \/ BackTick
Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
ByHome == axis.homed # "SWITCH" /\ io'.observed.homed = "SWITCH"

P17_reference ==
  [][ ByHome =>
        LET w == Shown(Counted) IN
        /\ w.shown = 4 /\ Rests(w) /\ Closed(w)
        /\ Magnitude(w.e2 - w.e1) <= k.home_tolerance_counts
        /\ io'.observed.position_counts = Read1.raw - w.e2 + k.home_offset_counts ]_vars

(* HOME takes the reference; nothing but HOME gives it here. *)
P17_not_before == [][ axis'.state = "HOMING" => axis'.homed = "NO" ]_vars

(* What the properties are about does happen: each says so. *)
About ==
  [][ /\ About1
      /\ ByHome => Met("P17_reference")
      /\ axis.homed = "SWITCH" /\ axis'.state = "HOMING" => Met("P17_not_before") ]_vars
===============================================================================
