----------------------------- MODULE KernelSystem -----------------------------
(* The system's machine under all its inputs: a person at the pedal, an E-stop, an
   app that lives, dies, is replaced or talks nonsense, a bus that fails, missed
   deadlines, damaged memory, and whatever the axes report. One step is one tick.

   At most one of the inputs departs from an ordinary tick at once; the pedal and
   the app's heartbeat are free. *)
EXTENDS System, Meets

CONSTANTS c,        \* the configuration, see SmallSystem
          Holders,  \* who may hold the control
          Slices    \* ticks of one pass over the configuration

SmallSystem ==
  [ pedal_channels |-> 2, app_timeout_ticks |-> 2, lease_max_ticks |-> 2,
    pedal_debounce_ticks |-> 2, pedal_disagree_ticks |-> 1,
    bad_frame_limit |-> 2, overrun_limit |-> 1 ]

VARIABLES
  system,         \* the kernel's record
  configuration,  \* of the environment: what the memory of the configuration holds
  seen,           \* of the properties: what a witness of the inputs has counted
  io              \* the last tick: inputs, requests, verdicts

vars == <<system, configuration, seen, io>>

(* Two states that differ in io alone are one, and causes_seen decides nothing.
   Properties of a tick are checked on every step, repeated ones included. *)
View == <<[system EXCEPT !.causes_seen = {}], configuration, seen>>

-------------------------------------------------------------------------------
(* Inputs *)
First == CHOOSE holder \in Holders : TRUE

Ordinary ==
  [ pedal_no |-> "OPEN", pedal_nc |-> "CLOSED", estop_loop |-> "CLOSED",
    deadline_missed |-> FALSE, any_valid |-> TRUE, new_attachment |-> FALSE,
    state_damaged |-> FALSE, config_damaged |-> FALSE,
    new_fault |-> FALSE, required_card_lost |-> FALSE, config_pass |-> "NONE",
    requests |-> <<>> ]

Request(kind, door) == [kind |-> kind, door |-> door, axis |-> 0, holder |-> First]
Heartbeat(holder)   == [Request("HEARTBEAT", "INTACT") EXCEPT !.holder = holder]

Quiet == {[Ordinary EXCEPT !.pedal_no = pedal[1], !.pedal_nc = pedal[2]] :
            pedal \in {<<"CLOSED", "OPEN">>, <<"OPEN", "CLOSED">>}}

Disturbed ==
  UNION {{[in EXCEPT !.pedal_nc = in.pedal_no],
          [in EXCEPT !.pedal_nc = "INVALID"],
          [in EXCEPT !.estop_loop = "OPEN"],
          [in EXCEPT !.estop_loop = "INVALID"],
          [in EXCEPT !.deadline_missed = TRUE],
          [in EXCEPT !.any_valid = FALSE],
          [in EXCEPT !.new_attachment = TRUE],
          [in EXCEPT !.state_damaged = TRUE],
          [in EXCEPT !.config_damaged = TRUE],
          [in EXCEPT !.new_fault = TRUE],
          [in EXCEPT !.required_card_lost = TRUE]} : in \in Quiet}

(* An app says one of these in an undisturbed tick, and of the first three in a
   disturbed one. *)
Ordinarily ==
  {<<>>, <<Heartbeat(First)>>, <<Heartbeat(First), Request("RESET", "INTACT")>>}

Spoken == Ordinarily \union
  {<<Heartbeat(holder)>> : holder \in Holders} \union
  {<<Request("STOP", "INTACT")>>, <<Request("RESET", "INTACT")>>,
   <<Request("NONSENSE", "INTACT")>>, <<Request("RESET", "CHECKSUM")>>,
   <<Request("RESET", "SEQUENCE")>>, <<Request("MOVE", "INTACT")>>}

Saying(inputs, spoken) == {[in EXCEPT !.requests = said] : said \in spoken, in \in inputs}

QuietInputs     == Saying(Quiet, Spoken)
DisturbedInputs == Saying(Disturbed, Ordinarily)

-------------------------------------------------------------------------------
(* The memory of the configuration and the pass over it, slice by slice. Damage
   to a slice that this pass has left behind is met by the next one. *)
Damaged(memory, in) ==
  IF memory.damaged THEN [memory EXCEPT !.age = CountUp(@, 2 * Slices)]
  ELSE IF in.config_damaged
  THEN [memory EXCEPT !.damaged = TRUE, !.missed = (memory.slice > 0)]
  ELSE memory

PassOutcome(memory) ==
  IF memory.slice < Slices - 1 THEN "NONE"
  ELSE IF memory.damaged /\ ~memory.missed THEN "DIFFERS"
  ELSE IF memory.valid THEN "AGREES" ELSE "INVALID"

AfterSlice(memory) ==
  IF memory.slice < Slices - 1 THEN [memory EXCEPT !.slice = @ + 1]
  ELSE [memory EXCEPT !.slice = 0, !.missed = FALSE]

-------------------------------------------------------------------------------
(* A tick *)
RECURSIVE Answered(_, _, _)
Answered(s, requests, answers) ==
  IF requests = <<>> THEN [system |-> s, answers |-> answers]
  ELSE LET request == Head(requests)
           door    == JudgeDoor(request, {})
           verdict == IF door = "ACCEPTED" THEN JudgeSystem(s, request) ELSE door
           after   == IF verdict = "ACCEPTED" THEN ApplySystem(s, request) ELSE s
           answer  == [kind |-> request.kind, verdict |-> verdict, before |-> s, after |-> after]
       IN  Answered(after, Tail(requests), Append(answers, answer))

Observed(s, in, outcome) ==
  LET input  == [in EXCEPT !.config_pass = outcome]
      alarms == [ configuration_damaged |-> outcome = "DIFFERS",
                  new_fault |-> in.new_fault,
                  required_card_lost |-> in.required_card_lost ]
      watched == ObserveSystem(c, ObserveBus(c, CheckConfiguration(s, input), input), input)
  IN  ChangeMode(c, watched, alarms)

(* What a witness who knows nothing of the kernel's counts has seen: for how long
   the app was silent and no frame valid, how long the pedal was released in READY
   with the app alive, whether that was consent, and how long it is pressed since.
   Leaving READY and a new holder begin it anew. *)
Nothing == [silence |-> c.app_timeout_ticks, bus |-> 0, releases |-> 0,
            consent |-> FALSE, presses |-> 0]

Witnessed(before, in) ==
  LET pedal   == ReadPedal(c, in)
      silence == IF in.new_attachment THEN c.app_timeout_ticks
                 ELSE CountUp(seen.silence, c.app_timeout_ticks)
      ready   == before.mode = "READY" /\ silence < c.app_timeout_ticks
      releases == IF ready /\ pedal = "RELEASED"
                  THEN CountUp(seen.releases, c.pedal_debounce_ticks) ELSE 0
  IN  [ silence  |-> silence,
        bus      |-> IF in.any_valid THEN 0 ELSE CountUp(seen.bus, c.bad_frame_limit),
        releases |-> releases,
        consent  |-> ready /\ (seen.consent \/ releases = c.pedal_debounce_ticks),
        presses  |-> IF ready /\ pedal = "PRESSED" /\ seen.consent
                     THEN CountUp(seen.presses, c.pedal_debounce_ticks) ELSE 0 ]

WasHeard(answers) ==
  \E i \in 1..Len(answers) :
    answers[i].kind = "HEARTBEAT" /\ answers[i].verdict = "ACCEPTED"

WitnessedLater(witness, before, after, answers) ==
  LET heard == [witness EXCEPT !.silence = IF WasHeard(answers) THEN 0 ELSE @]
  IN  IF after.mode = before.mode /\ after.holder = before.holder THEN heard
      ELSE [heard EXCEPT !.releases = 0, !.consent = FALSE, !.presses = 0]

-------------------------------------------------------------------------------
NoTick == [in |-> Ordinary, witness |-> Nothing, entered |-> FALSE, answers |-> <<>>]

Init ==
  /\ configuration \in [valid: BOOLEAN, damaged: {FALSE}, missed: {FALSE}, slice: {0}, age: {0}]
  /\ system = Booted(c, configuration.valid, First)
  /\ seen = Nothing
  /\ io = NoTick

(* Nothing of a damaged state is looked at, so the tick goes on with a new one. *)
Trusted(in) ==
  IF in.state_damaged THEN Rebuilt(c, "INTEGRITY", First) ELSE system

Restarted(in) ==
  IF in.state_damaged THEN [configuration EXCEPT !.slice = 0] ELSE configuration

(* A value bound as the element of a set is evaluated once. *)
Result(start, in, outcome) ==
  LET observed == IF start.mode = "INIT" THEN start ELSE Observed(start, in, outcome)
      answered == Answered(observed, in.requests, <<>>)
  IN  [ system |-> answered.system, answers |-> answered.answers,
        entered |-> system.mode # "MOTION" /\ observed.mode = "MOTION" ]

Step(in) ==
  \E start \in {Trusted(in)}, memory \in {Damaged(Restarted(in), in)} :
  \E result \in {Result(start, in, PassOutcome(memory))}, witness \in {Witnessed(system, in)} :
    /\ system' = result.system
    /\ configuration' = IF start.mode = "INIT" THEN memory ELSE AfterSlice(memory)
    /\ seen' = WitnessedLater(witness, system, result.system, result.answers)
    /\ io' = [ in |-> in, witness |-> witness, answers |-> result.answers,
               entered |-> result.entered ]

QuietTick     == Met("QuietTick") /\ \E in \in QuietInputs : Step(in)
DisturbedTick == Met("DisturbedTick") /\ \E in \in DisturbedInputs : Step(in)

Next == QuietTick \/ DisturbedTick

Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
(* Properties, as in kernel.md. In each the primed io is this very tick. *)
TypeOK ==
  /\ system \in SystemType(c, Holders)
  /\ configuration \in [valid: BOOLEAN, damaged: BOOLEAN, missed: BOOLEAN, slice: 0..(Slices - 1),
                       age: 0..(2 * Slices)]
  /\ SystemInvariant(c, system)

Silent == io'.witness.silence >= c.app_timeout_ticks

P2_stop ==
  [][ (\/ ReadPedal(c, io'.in) # "PRESSED"
       \/ io'.in.estop_loop # "CLOSED"
       \/ io'.witness.bus >= c.bad_frame_limit
       \/ Silent)
      => system'.mode # "MOTION" ]_vars

Reset == \E i \in 1..Len(io'.answers) :
           io'.answers[i].kind = "RESET" /\ io'.answers[i].verdict = "ACCEPTED"

Rewritten == io'.in.state_damaged

P8_latch ==
  [][ system.mode = "LOCKED" /\ ~Reset /\ ~Rewritten
      => /\ system'.mode = "LOCKED"
         /\ system'.cause = system.cause
         /\ system.causes_seen \subseteq system'.causes_seen ]_vars

P9_consent == [][ io'.entered => io'.witness.presses >= c.pedal_debounce_ticks ]_vars

P10_silence == [][ Silent => system'.mode # "MOTION" ]_vars

P11_inert_refusal ==
  [][ /\ Len(io'.answers) = Len(io'.in.requests)
      /\ \A i \in 1..Len(io'.answers) :
           io'.answers[i].verdict # "ACCEPTED" => io'.answers[i].after = io'.answers[i].before ]_vars

P13_configuration ==
  [][ system'.mode \in {"READY", "MOTION"}
      => configuration'.valid /\ (configuration'.damaged => configuration'.age < 2 * Slices) ]_vars

-------------------------------------------------------------------------------
(* What the properties are about does happen: each says so. *)
Verdict(verdict) == \E i \in 1..Len(io'.answers) : io'.answers[i].verdict = verdict

About ==
  [][ /\ system.mode = "MOTION" /\ ReadPedal(c, io'.in) = "RELEASED" => Met("P2_stop")
      /\ system.mode = "LOCKED" /\ system'.mode = "LOCKED"
         /\ system.causes_seen # system'.causes_seen => Met("P8_latch")
      /\ io'.entered => Met("P9_consent")
      /\ system.mode = "MOTION" /\ Silent => Met("P10_silence")
      /\ Verdict("CAUSE_PRESENT") => Met("P11_inert_refusal")
      /\ system.mode = "MOTION" /\ system'.cause = "INTEGRITY" /\ configuration'.damaged
         => Met("P13_configuration") ]_vars
===============================================================================
