----------------------------- MODULE KernelRunaway ----------------------------
(* Runaway. The axis moves though it is not driven, goes the other way, jumps, goes on
   moving when FAULTED; frames get lost, the card is lost, or begins anew. *)
EXTENDS KernelOne

RunawayAxis ==
  [WideAxis EXCEPT !.noise_counts = 0, !.max_drive = 1, !.reverse_counts = 1, !.drift_counts = 1,
                   !.max_delta_counts = 2]

RunawayBody == [Free EXCEPT !.low = -2, !.high = 2]

(* In MOTION anything; elsewhere a FAULTED axis may move, or one that is moved by hand. *)
Moves ==
  {m \in (IF system.mode = "MOTION" THEN {-2, -1, 0, 1, 3} ELSE {-2, 0, 1}) : Inside(m)}

Events ==
  {[m |-> m, reading |-> Reading(plant.at + m, FALSE)] : m \in Moves}
  \union {[m |-> m, reading |-> Lost] : m \in {n \in {0, 1} : Inside(n)}}
  \union {[m |-> 0, reading |-> [Reading(plant.at, FALSE) EXCEPT !.reset = TRUE]]}

Forth == MoveTo(body.high, 1, 1)

Wishes ==
  CASE system.mode = "LOCKED" -> {<<Ask("RESET"), Ask("CLEAR_FAULT")>>, <<>>}
    [] system.mode = "READY"  -> {<<Ask("CLEAR_FAULT"), Ask("ENABLE")>>, <<Ask("SET_HOME")>>, <<>>}
    [] OTHER -> {<<>>, <<Forth>>, <<Ask("DISABLE")>>, <<Ask("DISABLE"), Ask("ENABLE"), Forth>>}

(* Which way it was last driven since it was enabled, whether in the last tick, the
   farthest reading on that way; the reading from which drift counts; a run of readings
   at rest; loop periods since the last valid frame; whether a FAULTED axis has gone
   beyond drift and not come to rest. *)
Nothing == [way |-> "NONE", driven |-> FALSE, far |-> 0, from |-> 0, rest |-> RunAt(0), ticks |-> 1,
            loose |-> FALSE]

Compared == Read1.valid /\ axis.card_seen
Jumped   == Compared /\ Magnitude(Read1.raw - axis.raw) > k.max_delta_counts * seen.ticks
Anew     == Read1.valid /\ (~axis.card_seen \/ Read1.reset \/ Jumped)
Plain    == Compared /\ ~Anew

Resting ==
  IF ~Read1.valid \/ Anew \/ seen.driven THEN RunAt(io'.axis.raw)
  ELSE Prolonged(seen.rest, Read1.raw, k.noise_counts, k.rest_ticks)

Rests     == Read1.valid /\ Resting.ticks >= k.rest_ticks
ByHand    == axis.state = "DISABLED" /\ system.mode # "MOTION"
Away      == Plain /\ ~seen.driven /\ Magnitude(Read1.raw - seen.from) > k.drift_counts
NewlyFaulted == axis.state # "FAULTED" /\ axis'.state = "FAULTED"
IsLost    == ~io'.axis.card_seen
Loose     == axis.state = "FAULTED" /\ ~Rests /\ ~IsLost /\ (seen.loose \/ Away)

Witnessed ==
  LET now     == io'.axis.raw
      turned  == Driven /\ io'.command.direction # seen.way
      farther == Plain /\ Along(seen.way, now - seen.far) > 0
      idle    == ~IsEnabled(io'.axis) \/ ~IsEnabled(io'.observed)
  IN  [ way    |-> IF Driven THEN io'.command.direction ELSE IF idle THEN "NONE" ELSE seen.way,
        driven |-> Driven,
        far    |-> IF turned \/ farther \/ Anew THEN now
                   ELSE IF idle THEN 0 ELSE seen.far,
        from   |-> IF \/ Driven \/ Anew \/ NewlyFaulted
                      \/ (Accepted({"ENABLE"}) /\ io'.observed.state # "ENABLED")
                      \/ (ByHand /\ Read1.valid) \/ (axis.state = "FAULTED" /\ Rests)
                   THEN now ELSE seen.from,
        rest   |-> IF Driven THEN RunAt(now) ELSE Resting,
        ticks  |-> IF Read1.valid \/ IsLost THEN 1 ELSE seen.ticks + 1,
        loose  |-> Loose ]

Step(in, m, tails) == Tock(in, m, tails) /\ seen' = Witnessed

AnyTick == Met("AnyTick") /\ \E event \in Events :
  Step(Input(Held, event.reading, <<Beat>>), event.m, Wishes)

ReleaseTick == system.mode = "MOTION" /\ Met("ReleaseTick") /\ \E m \in {-2, 0} : Inside(m) /\
  Step(Input("OPEN", Reading(plant.at + m, FALSE), <<Beat>>), m, {<<>>})

Init ==
  /\ BeginIn(After(PowerOn, IntoMotion(0, <<Ask("SET_HOME"), Ask("ENABLE")>>)), 0)
  /\ seen = [Nothing EXCEPT !.rest.ticks = k.rest_ticks]

Next == AnyTick \/ ReleaseTick
Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
IsFaulted == io'.observed.state = "FAULTED"

P6_jump == [][ Jumped => IsFaulted /\ ~IsHomed(io'.observed) ]_vars

P6_reset_card == [][ Compared /\ Read1.reset => IsFaulted /\ ~IsHomed(io'.observed) ]_vars

P6_reverse ==
  [][ Plain /\ seen.driven /\ Along(seen.way, Read1.raw - seen.far) < -k.reverse_counts => IsFaulted ]_vars

P6_drift == [][ Away /\ ~ByHand => IsFaulted ]_vars

(* A FAULTED axis that goes on moving takes power away, in that tick and until it rests. *)
P6_runaway ==
  [][ /\ Loose => system'.mode = "LOCKED" /\ ~Accepted({"RESET"})
      /\ Accepted({"CLEAR_FAULT"}) => Rests ]_vars

(* What the properties are about does happen: each says so. *)
About ==
  [][ /\ About1
      /\ NewFault("JUMP") => Met("P6_jump")
      /\ NewFault("CARD_RESET") => Met("P6_reset_card")
      /\ NewFault("REVERSE") => Met("P6_reverse")
      /\ axis.state = "DISABLED" /\ NewFault("DRIFT") => Met("P6_drift")
      /\ system'.cause = "RUNAWAY" => Met("P6_runaway") ]_vars
===============================================================================
