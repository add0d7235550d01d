------------------------------ MODULE KernelStall -----------------------------
(* Stall. The counter does as it likes: sticks, dithers, creeps, goes back, is lost, or
   its card begins anew; requests come several in a tick, in any of these ticks. *)
EXTENDS KernelOne

StallAxis ==
  [WideAxis EXCEPT !.stall_ticks = 3, !.stall_effort_ticks = 2, !.stall_min_counts = 2]

StallBody == [Free EXCEPT !.low = 0, !.high = 2]

(* What happens to the reading. *)
Moves    == {m \in (IF system.mode = "MOTION" THEN {-1, 0, 1} ELSE {0}) : Inside(m)}
Readings == {[m |-> m, reading |-> Reading(plant.at + m, FALSE)] : m \in Moves}
            \union {[m |-> 0, reading |-> Lost]}

Forth == MoveTo(body.high, 2, 1)
Slow  == MoveTo(body.high, 1, 1)
Back  == MoveTo(body.low, 2, 1)

Wishes ==
  CASE system.mode = "LOCKED" -> {<<Ask("RESET")>>}
    [] system.mode = "READY"  -> {<<Ask("CLEAR_FAULT"), Ask("ENABLE")>>}
    [] OTHER -> {<<>>, <<Forth>>, <<Slow>>, <<Back>>, <<Ask("DISABLE")>>, <<Ask("ENABLE"), Forth>>}

(* Since the last progress or arrival of its own marks, or CLEAR_FAULT of a stall: ticks
   and effort driven; the way of the marks, which ENABLE ends, and the marks. *)
Nothing == [driven |-> 0, effort |-> 0, way |-> "NONE", far |-> 0, near |-> 0]

Beyond(mark) == Along(seen.way, Read1.raw - mark)

Enables == Accepted({"ENABLE"}) /\ ~IsEnabled(axis)
Whole   == Read1.valid /\ Beyond(seen.far) >= k.stall_min_counts
Some    == Read1.valid /\ Beyond(seen.near) > k.noise_counts
Arrived == /\ Read1.valid /\ io'.axis.state = "MOVING" /\ io'.system.mode = "MOTION" /\ ~Driven /\ ~Enables
           /\ Magnitude(io'.axis.setpoint_counts - io'.axis.position_counts) <= k.deadband_counts
           /\ Along(seen.way, Read1.raw - (IF Whole THEN Read1.raw ELSE seen.far)) > k.noise_counts
Excused == Accepted({"CLEAR_FAULT"}) /\ axis.fault = "STALL"
Renewed == Read1.valid /\ (Read1.reset \/ ~axis.card_seen)

Witnessed ==
  LET command == io'.command
      clear   == ~Renewed /\ (Whole \/ Arrived)
      driven  == IF clear \/ Excused THEN 0 ELSE seen.driven
      effort  == IF clear \/ Excused \/ (Some /\ ~Renewed) THEN 0 ELSE seen.effort
      anew    == (Driven /\ (Enables \/ command.direction # seen.way)) \/ Renewed \/ Excused
  IN  [ driven |-> CountBy(driven, IF Driven THEN 1 ELSE 0, k.stall_ticks + 1),
        effort |-> CountBy(effort, command.drive, (k.stall_effort_ticks + 1) * k.max_drive),
        way    |-> IF Driven THEN command.direction ELSE IF Enables THEN "NONE" ELSE seen.way,
        far    |-> IF anew THEN io'.axis.raw ELSE IF clear THEN Read1.raw ELSE seen.far,
        near   |-> IF anew THEN io'.axis.raw ELSE IF Whole \/ Some THEN Read1.raw ELSE seen.near ]

Step(in, m, tails) == Tock(in, m, tails) /\ seen' = Witnessed

AnyTick == Met("AnyTick") /\ \E event \in Readings :
  Step(Input(Held, event.reading, <<Beat>>), event.m, Wishes)

ReleaseTick == system.mode = "MOTION" /\ Met("ReleaseTick") /\
  Step(Input("OPEN", Reading(plant.at, FALSE), <<Beat>>), 0, {<<>>})

ResetTick == system.mode = "MOTION" /\ Met("ResetTick") /\ \E m \in {0, 1} : Inside(m) /\
  Step(Input(Held, [Reading(plant.at + m, FALSE) EXCEPT !.reset = TRUE], <<Beat>>), m, {<<>>})

Init ==
  /\ BeginIn(After(PowerOn, IntoMotion(0, <<Ask("SET_HOME"), Ask("ENABLE")>>)), 0)
  /\ seen = Nothing

Next == AnyTick \/ ReleaseTick \/ ResetTick
Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
(* A sum has reached its bound, and this tick's reading is no progress for it. *)
BoundMet ==
  \/ (seen.driven >= k.stall_ticks /\ ~(Whole /\ ~Renewed))
  \/ (seen.effort >= k.stall_effort_ticks * k.max_drive /\ ~((Whole \/ Some) /\ ~Renewed))

P5_stall ==
  [][ /\ BoundMet => io'.observed.state = "FAULTED"
      /\ seen'.driven <= k.stall_ticks
      /\ seen'.effort < (k.stall_effort_ticks + 1) * k.max_drive
      /\ Driven => io'.axis.state # "FAULTED" ]_vars

(* What the properties are about does happen: each says so. *)
About ==
  [][ /\ About1
      /\ NewFault("STALL") => Met("P5_stall") ]_vars
===============================================================================
