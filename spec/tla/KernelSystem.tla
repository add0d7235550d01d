----------------------------- MODULE KernelSystem -----------------------------
(* The system's machine under all its inputs: a person at the pedal, an E-stop, an
   app that lives, dies, is replaced, keeps an order for later or talks nonsense, a bus
   that fails, missed deadlines, damaged memory, and whatever the axes report. One step
   is one tick.

   In a tick come up to two requests in any order, with up to two of the things that
   depart from an ordinary tick; the pedal is free. *)
EXTENDS System, Meets

CONSTANTS c,        \* the configuration, see SmallSystem
          Holders,  \* who may hold the control
          Slices    \* ticks of one pass over the configuration

SmallSystem ==
  [ pedal_channels |-> 2, app_timeout_ticks |-> 2, lease_max_ticks |-> 2,
    power_up_ticks |-> 5, pedal_debounce_ticks |-> 2, pedal_disagree_ticks |-> 1,
    bad_frame_limit |-> 2, overrun_limit |-> 1 ]

VARIABLES
  system,         \* the kernel's record
  configuration,  \* of the environment: what the memory of the configuration holds
  order,          \* of the environment: the number that an order kept for later carries
  seen,           \* of the properties: what a witness of the inputs has counted
  io              \* the last tick: inputs, requests, verdicts

vars == <<system, configuration, order, seen, io>>

(* Two states that differ in io alone are one, and causes_seen decides nothing. *)
View == <<[system EXCEPT !.causes_seen = {}], configuration, order, seen>>

-------------------------------------------------------------------------------
(* Inputs *)
First == CHOOSE holder \in Holders : TRUE

(* Equality is the only comparison, so that three numbers stand for all: that of this
   press, that of the order kept, and one that is neither. *)
Fresh == CHOOSE number \in 1..3 : number \notin {system.consent, order}

Ordinary ==
  [ pedal_no |-> "OPEN", pedal_nc |-> "CLOSED", estop_loop |-> "CLOSED", missed |-> 0,
    any_valid |-> TRUE, new_attachment |-> FALSE, state_damaged |-> FALSE,
    config_damaged |-> FALSE, config_pass |-> "NONE", consent |-> Fresh,
    new_fault |-> FALSE, required_card_lost |-> FALSE, runaway |-> FALSE, restless |-> FALSE,
    requests |-> <<>> ]

Request(kind, door) == [kind |-> kind, door |-> door, axis |-> 0, holder |-> First, consent |-> order]
Heartbeat(holder)   == [Request("HEARTBEAT", "INTACT") EXCEPT !.holder = holder]

Departures ==
  {"pedal_nc", "estop_loop", "missed", "any_valid", "new_attachment", "state_damaged",
   "config_damaged", "new_fault", "required_card_lost", "runaway", "restless"}

Departed(in, names) ==
  [field \in DOMAIN in |->
     IF field \notin names THEN in[field]
     ELSE CASE field \in {"pedal_nc", "estop_loop"} -> "INVALID"
            [] field = "missed" -> 1
            [] OTHER -> ~in[field]]

Pedals == {[Ordinary EXCEPT !.pedal_no = pedal[1], !.pedal_nc = pedal[2]] :
             pedal \in {<<"CLOSED", "OPEN">>, <<"OPEN", "CLOSED">>}}

(* The app is heard in an ordinary tick, and says these besides; in a tick that is not
   ordinary it is silent, or asks for RESET, too. *)
Talk ==
  {<<>>, <<Heartbeat(First)>>, <<Heartbeat(3 - First), Heartbeat(First)>>, <<Request("STOP", "INTACT"), Heartbeat(First)>>,
   <<Request("RESET", "INTACT")>>, <<Request("NONSENSE", "INTACT"), Request("RESET", "CHECKSUM")>>,
   <<Request("MOVE", "INTACT"), Heartbeat(First)>>}

Brief == {<<>>, <<Heartbeat(First), Request("RESET", "INTACT")>>}

Saying(inputs, spoken) == {[in EXCEPT !.requests = said] : said \in spoken, in \in inputs}

Alone == {{name} : name \in Departures}
Pairs ==
  {{"estop_loop", "new_fault"}, {"runaway", "any_valid"}, {"new_attachment", "pedal_nc"},
   {"missed", "state_damaged"}, {"required_card_lost", "restless"}, {"new_fault", "config_damaged"}}

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
(* A tick. Of a MOVE only mode and consent are judged here. *)
JudgeConsent(s, request) ==
  IF s.mode # "MOTION" THEN "MODE"
  ELSE IF request.consent # s.consent THEN "CONSENT"
  ELSE "ACCEPTED"

JudgeAny(s, request) ==
  LET door == JudgeDoor(request, {0})
  IN  IF door # "ACCEPTED" THEN door
      ELSE IF request.kind \in AxisKinds THEN JudgeConsent(s, request)
      ELSE JudgeSystem(s, request)

ApplyAny(s, request) == IF request.kind \in AxisKinds THEN s ELSE ApplySystem(s, request)

RECURSIVE Answered(_, _, _)
Answered(s, requests, answers) ==
  IF requests = <<>> THEN [system |-> s, answers |-> answers]
  ELSE LET request == Head(requests)
           verdict == JudgeAny(s, request)
           after   == IF verdict = "ACCEPTED" THEN ApplyAny(s, request) ELSE s
           answer  == [kind |-> request.kind, verdict |-> verdict, before |-> s, after |-> after]
       IN  Answered(after, Tail(requests), Append(answers, answer))

Observed(s, in, outcome) ==
  LET input  == [in EXCEPT !.config_pass = outcome]
      alarms == [ configuration_damaged |-> outcome = "DIFFERS", new_fault |-> in.new_fault,
                  required_card_lost |-> in.required_card_lost, runaway |-> in.runaway,
                  restless |-> in.restless ]
      watched == ObserveSystem(c, ObserveBus(c, CheckConfiguration(s, input), input), input)
  IN  ChangeMode(c, watched, alarms, in.consent)

(* What a witness who knows nothing of the kernel's counts has seen: for how long the
   app was silent, no frame valid and power on, how long the pedal was released in READY
   with the app alive, whether that was consent, how long it is pressed since, and
   whether that press has ended. Leaving READY, STOP, silence and a new holder begin it
   anew. `known`: the order kept was made in this press. *)
Nothing == [silence |-> c.app_timeout_ticks, bus |-> 0, power |-> 0, releases |-> 0,
            consent |-> FALSE, presses |-> 0, known |-> FALSE]

Witnessed(before, in) ==
  LET pedal    == ReadPedal(c, in)
      silence  == IF in.new_attachment THEN c.app_timeout_ticks
                  ELSE CountUp(seen.silence, c.app_timeout_ticks)
      ready    == before.mode = "READY" /\ silence < c.app_timeout_ticks
      releases == IF ready /\ pedal = "RELEASED"
                  THEN CountUp(seen.releases, c.pedal_debounce_ticks) ELSE 0
      presses  == IF ready /\ pedal = "PRESSED" /\ seen.consent
                  THEN CountUp(seen.presses, c.pedal_debounce_ticks) ELSE 0
  IN  [ silence  |-> silence,
        bus      |-> IF in.any_valid THEN 0 ELSE CountUp(seen.bus, c.bad_frame_limit),
        power    |-> IF Power(before) THEN CountUp(seen.power, c.power_up_ticks) ELSE 0,
        releases |-> releases,
        consent  |-> ready /\ (seen.consent \/ releases = c.pedal_debounce_ticks),
        presses  |-> presses,
        known    |-> seen.known ]

Was(kind, answers) ==
  \E i \in 1..Len(answers) : answers[i].kind = kind /\ answers[i].verdict = "ACCEPTED"

HolderChanged(answers) ==
  \E i \in 1..Len(answers) : answers[i].before.holder # answers[i].after.holder

(* A press that has completed is over, whether MOTION began or not. *)
WitnessedLater(witness, before, after, answers, known) ==
  LET heard == [witness EXCEPT !.silence = IF Was("HEARTBEAT", answers) THEN 0 ELSE @,
                               !.power = IF Power(after) THEN @ ELSE 0, !.known = known]
      over  == \/ after.mode # before.mode
               \/ HolderChanged(answers)
               \/ Was("STOP", answers)
               \/ witness.presses = c.pedal_debounce_ticks
  IN  IF over THEN [heard EXCEPT !.releases = 0, !.consent = FALSE, !.presses = 0] ELSE heard

-------------------------------------------------------------------------------
NoTick == [in |-> <<>>, witness |-> Nothing, entered |-> FALSE, answers |-> <<>>]

Init ==
  /\ configuration \in [valid: BOOLEAN, damaged: {FALSE}, missed: {FALSE}, slice: {0}, age: {0}]
  /\ system = Booted(c, configuration.valid, First)
  /\ order = 0
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
        completed |-> start.mode = "READY" /\ observed.mode = "MOTION",
        entered |-> system.mode # "MOTION" /\ observed.mode = "MOTION" ]

(* At the end of a tick an author may keep an order with the number that he sees. *)
Step(in, keeps) ==
  \E start \in {Trusted(in)}, memory \in {Damaged(Restarted(in), in)} :
  \E result \in {Result(start, in, PassOutcome(memory))}, witness \in {Witnessed(system, in)} :
    /\ system' = result.system
    /\ configuration' = IF start.mode = "INIT" THEN memory ELSE AfterSlice(memory)
    /\ order' = IF keeps THEN result.system.consent ELSE order
    /\ seen' = WitnessedLater(witness, system, result.system, result.answers,
                 /\ result.system.mode = "MOTION"
                 /\ keeps \/ (seen.known /\ system.mode = "MOTION"))
    /\ io' = [ in |-> in, witness |-> witness, answers |-> result.answers,
               entered |-> result.entered ]

QuietTick == Met("QuietTick") /\ \E in \in Saying(Pedals, Talk) : Step(in, FALSE)
OrderTick == Met("OrderTick") /\ order # system.consent /\ \E in \in Saying(Pedals, {<<Heartbeat(First)>>}) : Step(in, TRUE)
DisturbedTick == Met("DisturbedTick") /\ \E in \in Saying(Pedals, Brief), names \in Alone \union Pairs :
  Step(Departed(in, names), FALSE)

Next == QuietTick \/ OrderTick \/ DisturbedTick

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
       \/ io'.in.runaway \/ io'.in.missed >= c.overrun_limit
       \/ Silent \/ Was("STOP", io'.answers) \/ HolderChanged(io'.answers))
      => system'.mode # "MOTION" ]_vars

P2_new_fault ==
  [][ system.mode = "MOTION" /\ (io'.in.new_fault \/ io'.in.required_card_lost)
      => system'.mode # "MOTION" ]_vars

Reset     == Was("RESET", io'.answers)
Rewritten == io'.in.state_damaged

P8_latch ==
  [][ system.mode = "LOCKED" /\ ~Reset /\ ~Rewritten
      => /\ system'.mode = "LOCKED"
         /\ system'.cause = system.cause
         /\ system.causes_seen \subseteq system'.causes_seen ]_vars

Blocked == io'.in.required_card_lost \/ io'.in.restless \/ io'.witness.power < c.power_up_ticks

P9_consent ==
  [][ io'.entered => io'.witness.presses >= c.pedal_debounce_ticks /\ ~Blocked ]_vars

P10_silence == [][ Silent => system'.mode # "MOTION" ]_vars

P11_inert_refusal ==
  [][ /\ Len(io'.answers) = Len(io'.in.requests)
      /\ \A i \in 1..Len(io'.answers) :
           io'.answers[i].verdict # "ACCEPTED" => io'.answers[i].after = io'.answers[i].before ]_vars

(* An order that was made in another press, or in none, moves nothing. *)
P12_no_leap == [][ Was("MOVE", io'.answers) => seen.known ]_vars

P13_configuration ==
  [][ system'.mode \in {"READY", "MOTION"}
      => configuration'.valid /\ (configuration'.damaged => configuration'.age < 2 * Slices) ]_vars

-------------------------------------------------------------------------------
(* What the properties are about does happen: each says so. *)
Verdict(verdict) == \E i \in 1..Len(io'.answers) : io'.answers[i].verdict = verdict

About ==
  [][ /\ system.mode = "MOTION" /\ ReadPedal(c, io'.in) = "RELEASED" => Met("P2_stop")
      /\ system.mode = "MOTION" /\ io'.in.new_fault /\ system'.mode = "READY" => Met("P2_new_fault")
      /\ system.mode = "LOCKED" /\ system'.mode = "LOCKED"
         /\ system.causes_seen # system'.causes_seen => Met("P8_latch")
      /\ io'.entered => Met("P9_consent")
      /\ system.mode = "MOTION" /\ Silent => Met("P10_silence")
      /\ Verdict("CAUSE_PRESENT") => Met("P11_inert_refusal")
      /\ Was("MOVE", io'.answers) => Met("P12_no_leap")
      /\ system.mode = "MOTION" /\ system'.cause = "INTEGRITY" /\ configuration'.damaged
         => Met("P13_configuration") ]_vars
===============================================================================
