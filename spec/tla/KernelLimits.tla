----------------------------- MODULE KernelLimits -----------------------------
(* Limits and travel of a lawful plant, which coasts, also after a reversal, and whose
   readings dither by a count. Requests come several in a tick. With `Unhomed` the axis
   has no reference, and the two budgets of a press are looked at; else it was homed by
   hand, and the soft range. *)
EXTENDS KernelOne

CONSTANT Unhomed

(* Coast as read: one count beyond the last driven one, and one of noise. *)
SoftAxis ==
  [WideAxis EXCEPT !.limit_side = "LOWER", !.min_counts = -1, !.max_counts = 5, !.coast_counts = 2,
                   !.home_offset_counts = -1, !.max_drive = 1]

SoftBody == [Free EXCEPT !.low = -2, !.high = 7, !.closes = -2, !.opens = -1]

BudgetAxis ==
  [SoftAxis EXCEPT !.max_drive = 2, !.unhomed_travel_counts = 4, !.home_travel_counts = 5, !.switch_debounce_ticks = 1,
                   !.home_clear_counts = 1]

BudgetBody == [Free EXCEPT !.low = -5, !.high = 5, !.closes = -1, !.opens = -1]

Events ==
  {[m |-> m, reading |-> Reading(plant.at + m + n, switch)] :
     m \in {m \in LawfulMoves : Inside(m)}, n \in {0, 1}, switch \in Contact(plant.at)}
  \union {[m |-> m, reading |-> Lost] : m \in {m \in LawfulMoves : Inside(m)}}

There == MoveTo(IF Unhomed THEN axis.position_counts + 1 ELSE 3, 1, 1)
Here  == MoveTo(IF Unhomed THEN axis.position_counts - 1 ELSE 1, 1, 1)
Fast  == [There EXCEPT !.drive = k.max_drive]
Old   == [Here EXCEPT !.consent = 2]
Off   == <<Ask("DISABLE"), Ask("ENABLE")>>

Wishes ==
  CASE system.mode = "LOCKED" -> {<<Ask("RESET")>>}
    [] system.mode = "READY"  -> {<<Ask("CLEAR_FAULT"), Ask("ENABLE")>>}
    [] Unhomed /\ axis.state = "DISABLED" -> {<<>>} \union {<<Ask("ENABLE"), asked>> : asked \in {There, Here, Ask("HOME")}}
    [] Unhomed -> {<<>>, <<Fast>>, <<There>>, <<Here>>, <<Ask("HOME")>>, Off \o <<There>>, Off \o <<Ask("HOME")>>}
    [] OTHER -> {<<>>, <<There>>, <<Here>>, <<MoveTo(k.max_counts, 1, 1), Old>>, Off \o <<Here>>}

(* The travel of this press by MOVE and by HOME, the point that follows the counter, and
   to which of the two its path belongs. *)
Nothing == [by |-> "MOVE", move |-> 0, home |-> 0, point |-> 0]

Witnessed ==
  LET now    == io'.axis.raw
      far    == Magnitude(now - seen.point)
      path   == IF far > k.noise_counts /\ ~IsHomed(axis) THEN far ELSE 0
      begun  == io'.system.mode = "MOTION" /\ system.mode # "MOTION"
      home   == Accepted({"HOME"})
      move   == Driven /\ io'.axis.state = "MOVING"
  IN  IF ~Unhomed \/ io'.system.mode # "MOTION" THEN Nothing
      ELSE IF begun THEN [Nothing EXCEPT !.point = now]
      ELSE [ by    |-> IF move THEN "MOVE" ELSE IF home THEN "HOME" ELSE seen.by,
             move  |-> seen.move + (IF seen.by = "MOVE" THEN path ELSE 0),
             home  |-> seen.home + (IF seen.by = "HOME" THEN path ELSE 0),
             point |-> IF path # 0 \/ (IsHomed(axis) /\ Read1.valid) THEN now ELSE seen.point ]

Step(in, m, tails) == Tock(in, m, tails) /\ seen' = Witnessed

AnyTick == Met("AnyTick") /\ \E event \in Events :
  Step(Input(Held, event.reading, <<Beat>>), event.m, Wishes)

EndTick == system.mode = "MOTION" /\ Met("EndTick") /\
  \E pedal \in {"OPEN", "CLOSED"}, estop \in {"OPEN", "CLOSED"}, m \in {m \in LawfulMoves : Inside(m)} :
    Step([Input(pedal, Reading(plant.at + m, plant.at <= body.closes), <<>>) EXCEPT !.estop_loop = estop], m,
         {<<>>, <<There>>})

Init ==
  /\ BeginIn(After(PowerOn, IntoMotion(0, (IF Unhomed THEN <<>> ELSE <<Ask("SET_HOME")>>) \o <<Ask("ENABLE")>>)), 0)
  /\ seen = Nothing

Next == AnyTick \/ EndTick
Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
(* Properties, as in kernel.md. *)
P4_soft_limit ==
  [][ Driven /\ IsHomed(io'.axis) =>
        /\ io'.command.direction = "INCREASING"
           => io'.axis.position_counts < k.max_counts - k.coast_counts
        /\ io'.command.direction = "DECREASING"
           => io'.axis.position_counts > k.min_counts + k.coast_counts ]_vars

InRange(a) == a.position_counts \in k.min_counts..k.max_counts

P4_soft_range == [][ IsHomed(axis) /\ IsHomed(io'.axis) /\ InRange(axis) => InRange(io'.axis) ]_vars

P7_bounds ==
  [][ /\ io'.command.drive <= k.max_drive
      /\ ~IsHomed(io'.axis) => io'.command.drive <= k.unhomed_max_drive ]_vars

P7_travel ==
  [][ seen'.move <= k.unhomed_travel_counts /\ seen'.home <= k.home_travel_counts ]_vars

(* What the properties are about does happen: each says so. *)
About ==
  [][ /\ About1
      /\ Driven /\ IsHomed(io'.axis) /\ io'.command.direction = "INCREASING"
         /\ io'.axis.position_counts + 1 = k.max_counts - k.coast_counts => Met("P4_soft_limit")
      /\ IsHomed(io'.axis) /\ io'.axis.position_counts = k.max_counts - 1 => Met("P4_soft_range")
      /\ Driven /\ Unhomed => Met("P7_bounds")
      /\ (\E i \in 1..Len(io'.answers) : io'.answers[i].verdict = "CONSENT") => Met("P12_no_leap")
      /\ seen'.move = k.unhomed_travel_counts - 1 => Met("P7_travel") ]_vars
===============================================================================
