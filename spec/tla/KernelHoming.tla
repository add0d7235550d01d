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

(* Driven, a count that way or none; when the slow approach has just ended, it may coast. *)
Coasts == axis.homing_phase = "APPROACH_SLOWLY" /\ axis.switch_triggered

Moves ==
  {m \in (IF axis.driven_direction # "NONE" THEN {0, Sense(axis.driven_direction)}
          ELSE IF Coasts THEN {-1, 0} ELSE {0}) : Inside(m)}

Events ==
  {[m |-> m, reading |-> Reading(plant.at + m, switch)] : m \in Moves, switch \in BOOLEAN}
  \union {[m |-> 0, reading |-> Lost]}

Wishes ==
  IF axis.state = "HOMING" THEN {<<>>, <<Ask("DISABLE"), Ask("ENABLE"), Ask("HOME")>>}
  ELSE {<<Ask("ENABLE"), Ask("HOME")>>}

(* What the inputs have shown since HOME: a run of readings of the switch with the counter
   at its first; whether it was open since the last edge; the edges that may be e1, and
   whether it was open and clear of each, and driven slowly since; those that may then be
   e2; and a run at rest. *)
Nothing == [open |-> FALSE, triggered |-> FALSE, ticks |-> 0, raw |-> 0, firsts |-> {}, seconds |-> {},
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
Clear(e)  == Along(AwayFromSwitch(k), Read1.raw - e.at) >= k.home_clear_counts
Agree(w)  == \E e \in w.firsts : e.clear /\ Magnitude(w.raw - e.at) <= k.home_tolerance_counts

Shown(w) ==
  CASE ~Read1.valid -> w
    [] Open(w) -> [w EXCEPT !.open = TRUE, !.firsts = {[e EXCEPT !.clear = @ \/ Clear(e)] : e \in @}]
    [] Closed(w) /\ w.open ->
         [w EXCEPT !.open = FALSE, !.firsts = @ \union {[at |-> w.raw, clear |-> FALSE]},
                   !.seconds = IF Agree(w) THEN @ \union {w.raw} ELSE @]
    [] OTHER -> w

(* Too fast: whatever approach this is, it is not the slow one. *)
Witnessed ==
  LET w    == Shown(Counted)
      fast == io'.command.drive > k.home_slow_drive
  IN  IF axis'.state # "HOMING" \/ Accepted({"HOME"}) THEN Nothing
      ELSE [w EXCEPT !.driven = Driven,
                     !.firsts = IF fast THEN {[e EXCEPT !.clear = FALSE] : e \in @} ELSE @,
                     !.seconds = IF fast THEN {} ELSE @,
                     !.raw = IF w.triggered /\ w.open THEN @ ELSE 0,
                     !.rest = IF Driven THEN RunAt(0) ELSE @]

Step(in, m, tails) == Tock(in, m, tails) /\ seen' = Witnessed

AnyTick == system.mode = "MOTION" /\ Met("AnyTick") /\ \E event \in Events :
  Step(Input("CLOSED", event.reading, <<Beat>>), event.m, Wishes)

ReleaseTick == system.mode = "MOTION" /\ Met("ReleaseTick") /\
  Step(Input("OPEN", Reading(plant.at, plant.at <= body.closes), <<Beat>>), 0, {<<>>})

(* Back into MOTION, whatever has happened, with a switch that reads true. *)
Remedy ==
  IF system.mode = "LOCKED" THEN <<Ask("RESET")>>
  ELSE <<Ask("CLEAR_FAULT"), Ask("ENABLE")>>

BackTick == system.mode # "MOTION" /\ Met("BackTick") /\
  Step(Input(IF axis.state = "FAULTED" THEN "OPEN" ELSE Held,
             Reading(plant.at, plant.at <= body.closes), <<Beat>> \o Remedy), 0, {<<>>})

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
        /\ Rests(w) /\ Closed(w)
        /\ \E e2 \in w.seconds :
             io'.observed.position_counts = Read1.raw - e2 + k.home_offset_counts ]_vars

(* HOME takes the reference; nothing but HOME gives it here. *)
P17_not_before == [][ axis'.state = "HOMING" => axis'.homed = "NO" ]_vars

(* What the properties are about does happen: each says so. *)
About ==
  [][ /\ About1
      /\ ByHome => Met("P17_reference")
      /\ axis.homed = "SWITCH" /\ axis'.state = "HOMING" => Met("P17_not_before") ]_vars
===============================================================================
