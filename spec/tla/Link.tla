-------------------------------- MODULE Link --------------------------------
(***************************************************************************)
(* The link between kernel and app: kernel/host/ring_reader.c, publisher.c,*)
(* link_reader.c, loop.c.                                                  *)
(*                                                                         *)
(* Kernel to app: a snapshot under a seqlock and a bounded ring of events, *)
(* which the app can only read. App to kernel: a ring of requests, which   *)
(* only the app writes.                                                    *)
(*                                                                         *)
(* A lying app may write anything anywhere in its region at any time, so   *)
(* each load from it gives any value at all; that is the strongest liar.   *)
(* A crashed app is one that takes no further step. Each load and store of *)
(* a shared word is a step of its own. Words between two fences are stored *)
(* and loaded in any order, which covers relaxed accesses.                 *)
(***************************************************************************)
EXTENDS Integers, Sequences, Meets

CONSTANTS
  Lying,         \* TRUE: the app's region holds anything; FALSE: what an honest app wrote
  Ring,          \* slots of the request ring (ILK_LINK_REQUESTS)
  PerTick,       \* requests that one tick looks at (ILK_REQUESTS_PER_TICK)
  Wrap,          \* the ring's counters count modulo this (2^32)
  Sequences,     \* largest sequence number
  EventSlots,    \* slots of the event ring (ILK_LINK_EVENTS)
  Ticks,         \* ticks that are looked at
  Generations    \* attachments that are looked at

VARIABLES
  kernel,        \* where the kernel is in its tick
  tick,          \* ticks begun
  generation,    \* the attachment that the kernel serves
  source,        \* the attachment whose ring the kernel copies from
  tail,          \* requests consumed, the kernel's own copy
  taken,         \* requests consumed in this attachment, never wrapping: names a place in the ring's history
  count,         \* requests that this tick still copies
  partial,       \* words copied so far of the record that is being copied
  batch,         \* private copies: [record, place, from]
  last_sequence, \* newest sequence number of this attachment
  work,          \* loads from the app's region in this tick
  answered,      \* places that have a verdict
  verdict,       \* the latest verdict: [used, record, from, again, newer]
  ring, head,    \* the app's region: slots and requests written
  shared_tail,   \* requests consumed, as the app sees it
  put, putting,  \* honest app: requests written, and words written of the next one
  lock, snap,    \* seqlock and the snapshot's words; a snapshot's words all hold its tick
  stored,        \* words of the snapshot stored so far
  events, slots, \* the kernel's count of events, and the event ring
  event_head,    \* events written, as the app sees it
  reader,        \* where the app's reader is
  seen,          \* what it has loaded
  next, got, lost \* events: the next one, those received, those missed

private == <<tick, generation, source, tail, taken, count, partial, batch, last_sequence, work, answered, verdict>>
app_region == <<ring, head, put, putting>>
snapshot == <<lock, snap, stored>>
event_ring == <<events, slots, event_head>>
reading == <<reader, seen, next, got, lost>>
vars == <<kernel, private, app_region, shared_tail, snapshot, event_ring, reading>>

Fields == {"sequence", "body", "crc"}
Word(field) == IF field = "sequence" THEN 0..Sequences ELSE 0..1
Crc(record) == (record.sequence + record.body) % 2
IsSound(record) == record.crc = Crc(record)
Honest(number) == [sequence |-> number, body |-> 0, crc |-> number % 2]
Blank == [sequence |-> 0, body |-> 0, crc |-> 1]
SnapshotWords == {"first", "second"}
EventWords == {"a", "b"}
NoVerdict == [used |-> FALSE, record |-> Blank, from |-> 0, again |-> FALSE, newer |-> FALSE]
BlankEvent == [number |-> 0, a |-> 0, b |-> 0]
Nothing == <<>>

\* ---- What a fresh attachment looks like: new regions, counters at zero ----
FreshRegions ==
  /\ ring' = [slot \in 0..Ring - 1 |-> Blank] /\ head' = 0 /\ put' = 0 /\ putting' = {}
  /\ shared_tail' = 0
  /\ lock' = 0 /\ snap' = [word \in SnapshotWords |-> 0] /\ stored' = {}
  /\ events' = 0 /\ slots' = [slot \in 0..EventSlots - 1 |-> BlankEvent] /\ event_head' = 0
  /\ reader' = "idle" /\ seen' = Nothing /\ next' = 0 /\ got' = 0 /\ lost' = 0

Init ==
  /\ kernel = "begin" /\ tick = 0 /\ generation = 1 /\ source = 1 /\ tail = 0 /\ taken = 0 /\ count = 0
  /\ partial = Nothing /\ batch = <<>> /\ last_sequence = 0 /\ work = 0 /\ answered = {} /\ verdict = NoVerdict
  /\ ring = [slot \in 0..Ring - 1 |-> Blank] /\ head = 0 /\ put = 0 /\ putting = {}
  /\ shared_tail = 0
  /\ lock = 0 /\ snap = [word \in SnapshotWords |-> 0] /\ stored = {}
  /\ events = 0 /\ slots = [slot \in 0..EventSlots - 1 |-> BlankEvent] /\ event_head = 0
  /\ reader = "idle" /\ seen = Nothing /\ next = 0 /\ got = 0 /\ lost = 0

\* ---- The kernel's tick ----
Begin ==
  /\ kernel = "begin" /\ tick < Ticks
  /\ tick' = tick + 1 /\ work' = 0 /\ verdict' = NoVerdict
  /\ kernel' = "exchange"
  /\ UNCHANGED <<generation, source, tail, taken, count, partial, batch, last_sequence, answered>>
  /\ UNCHANGED <<app_region, shared_tail, snapshot, event_ring, reading>>

\* serve_newest_attachment: the app is gone and another one has attached.
Attach ==
  /\ kernel = "exchange" /\ generation < Generations
  /\ generation' = generation + 1 /\ source' = generation + 1
  /\ tail' = 0 /\ taken' = 0 /\ last_sequence' = 0 /\ answered' = {}
  /\ FreshRegions
  /\ kernel' = "head"
  /\ UNCHANGED <<tick, count, partial, batch, work, verdict>>

Stay ==
  /\ kernel = "exchange"
  /\ kernel' = "head"
  /\ UNCHANGED <<private, app_region, shared_tail, snapshot, event_ring, reading>>

\* ilk_ring_read: one load of the head; a head farther ahead than the ring is long is a lie, and all of it is skipped.
LoadHead ==
  /\ kernel = "head"
  /\ \E loaded \in IF Lying THEN 0..Wrap - 1 ELSE {head} :
       LET waiting == (loaded - tail) % Wrap IN
       IF waiting > Ring
       THEN /\ tail' = loaded /\ count' = 0
            /\ UNCHANGED taken
       ELSE /\ count' = IF waiting < PerTick THEN waiting ELSE PerTick
            /\ UNCHANGED <<tail, taken>>
  /\ work' = work + 1
  /\ kernel' = "copy"
  /\ UNCHANGED <<tick, generation, source, partial, batch, last_sequence, answered, verdict>>
  /\ UNCHANGED <<app_region, shared_tail, snapshot, event_ring, reading>>

\* Each word is loaded once, into memory of the kernel's own.
LoadWord ==
  /\ kernel = "copy" /\ count > 0
  /\ \E field \in Fields \ DOMAIN partial :
       \E loaded \in IF Lying THEN Word(field) ELSE {ring[tail % Ring][field]} :
         LET copied == [known \in DOMAIN partial \cup {field} |-> IF known = field THEN loaded ELSE partial[known]] IN
         IF DOMAIN copied # Fields
         THEN /\ partial' = copied
              /\ UNCHANGED <<batch, tail, taken, count>>
         ELSE /\ partial' = Nothing
              /\ batch' = Append(batch, [record |-> copied, place |-> taken, from |-> source])
              /\ tail' = (tail + 1) % Wrap
              /\ taken' = taken + 1
              /\ count' = count - 1
  /\ work' = work + 1
  /\ UNCHANGED <<kernel, tick, generation, source, last_sequence, answered, verdict>>
  /\ UNCHANGED <<app_region, shared_tail, snapshot, event_ring, reading>>

CopyDone ==
  /\ kernel = "copy" /\ count = 0
  /\ kernel' = "judge"
  /\ UNCHANGED <<private, app_region, shared_tail, snapshot, event_ring, reading>>

\* ilk_request_judge on the private copy: CHECKSUM, SEQUENCE, then use.
Judge ==
  /\ kernel = "judge" /\ batch # <<>>
  /\ LET copy == Head(batch)
         record == copy.record
         newer == record.sequence > last_sequence
         used == IsSound(record) /\ newer
     IN /\ verdict' = [used |-> used, record |-> record, from |-> copy.from,
                       again |-> copy.place \in answered, newer |-> newer]
        /\ answered' = answered \cup {copy.place}
        /\ last_sequence' = IF used THEN record.sequence ELSE last_sequence
  /\ batch' = Tail(batch)
  /\ kernel' = "event number"
  /\ UNCHANGED <<tick, generation, source, tail, taken, count, partial, work>>
  /\ UNCHANGED <<app_region, shared_tail, snapshot, event_ring, reading>>

\* put_event: the number is cleared, the words are stored, the number is set, the head moves.
Slot == events % EventSlots

ClearNumber ==
  /\ kernel = "event number"
  /\ slots' = [slots EXCEPT ![Slot].number = 0]
  /\ kernel' = "event words"
  /\ UNCHANGED <<private, app_region, shared_tail, snapshot, events, event_head, reading>>

StoreEventWord ==
  /\ kernel = "event words"
  /\ \E word \in EventWords :
       /\ slots[Slot][word] # events + 1
       /\ slots' = [slots EXCEPT ![Slot][word] = events + 1]
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, events, event_head, reading>>

SetNumber ==
  /\ kernel = "event words"
  /\ \A word \in EventWords : slots[Slot][word] = events + 1
  /\ slots' = [slots EXCEPT ![Slot].number = events + 1]
  /\ events' = events + 1
  /\ kernel' = "event head"
  /\ UNCHANGED <<private, app_region, shared_tail, snapshot, event_head, reading>>

MoveHead ==
  /\ kernel = "event head"
  /\ event_head' = events
  /\ kernel' = "judge"
  /\ UNCHANGED <<private, app_region, shared_tail, snapshot, events, slots, reading>>

\* ilk_publisher_publish: what was consumed, then the snapshot between an odd and an even lock.
PublishTail ==
  /\ kernel = "judge" /\ batch = <<>>
  /\ shared_tail' = tail
  /\ kernel' = "lock"
  /\ UNCHANGED <<private, app_region, snapshot, event_ring, reading>>

Lock ==
  /\ kernel = "lock"
  /\ lock' = lock + 1
  /\ stored' = {}
  /\ kernel' = "words"
  /\ UNCHANGED <<private, app_region, shared_tail, snap, event_ring, reading>>

StoreWord ==
  /\ kernel = "words"
  /\ \E word \in SnapshotWords \ stored :
       /\ snap' = [snap EXCEPT ![word] = tick]
       /\ stored' = stored \cup {word}
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, lock, event_ring, reading>>

Unlock ==
  /\ kernel = "words" /\ stored = SnapshotWords
  /\ lock' = lock + 1
  /\ kernel' = "begin"
  /\ UNCHANGED <<private, app_region, shared_tail, snap, stored, event_ring, reading>>

KernelStep ==
  \/ Begin /\ Met("Begin")
  \/ Attach /\ Met("Attach")
  \/ Stay /\ Met("Stay")
  \/ LoadHead /\ Met("LoadHead")
  \/ LoadWord /\ Met("LoadWord")
  \/ CopyDone /\ Met("CopyDone")
  \/ Judge /\ Met("Judge")
  \/ ClearNumber /\ Met("ClearNumber")
  \/ StoreEventWord /\ Met("StoreEventWord")
  \/ SetNumber /\ Met("SetNumber")
  \/ MoveHead /\ Met("MoveHead")
  \/ PublishTail /\ Met("PublishTail")
  \/ Lock /\ Met("Lock")
  \/ StoreWord /\ Met("StoreWord")
  \/ Unlock /\ Met("Unlock")

\* ---- The app's writer, when it is honest: ilk_link_put_request ----
PutWord ==
  /\ ~Lying /\ put < Sequences
  /\ (put - shared_tail) % Wrap < Ring
  /\ \E field \in Fields \ putting :
       /\ ring' = [ring EXCEPT ![put % Ring][field] = Honest(put + 1)[field]]
       /\ putting' = putting \cup {field}
  /\ UNCHANGED <<kernel, private, head, put, shared_tail, snapshot, event_ring, reading>>

PutDone ==
  /\ putting = Fields
  /\ put' = put + 1 /\ head' = (put + 1) % Wrap /\ putting' = {}
  /\ UNCHANGED <<kernel, private, ring, shared_tail, snapshot, event_ring, reading>>

\* ---- The app's reader: ilk_link_read_snapshot ----
ReadLock ==
  /\ reader = "idle"
  /\ lock # 0 /\ lock % 2 = 0
  /\ seen' = [lock |-> lock]
  /\ reader' = "snapshot"
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, event_ring, next, got, lost>>

ReadWord ==
  /\ reader = "snapshot"
  /\ \E word \in SnapshotWords \ DOMAIN seen :
       seen' = [known \in DOMAIN seen \cup {word} |-> IF known = word THEN snap[word] ELSE seen[known]]
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, event_ring, reader, next, got, lost>>

CheckLock ==
  /\ reader = "snapshot" /\ SnapshotWords \subseteq DOMAIN seen
  /\ reader' = IF lock = seen["lock"] THEN "snapshot accepted" ELSE "idle"
  /\ seen' = IF lock = seen["lock"] THEN seen ELSE Nothing
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, event_ring, next, got, lost>>

\* ---- ilk_link_next_event ----
FindEvent ==
  /\ reader = "idle" /\ event_head > next
  /\ LET first == IF event_head - next > EventSlots THEN event_head - EventSlots ELSE next
         found == slots[first % EventSlots].number = first + 1
     IN /\ lost' = lost + (first - next) + (IF found THEN 0 ELSE 1)
        /\ next' = first + 1
        /\ reader' = IF found THEN "event" ELSE "idle"
        /\ seen' = Nothing
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, event_ring, got>>

ReadEventWord ==
  /\ reader = "event"
  /\ \E word \in EventWords \ DOMAIN seen :
       seen' = [known \in DOMAIN seen \cup {word} |->
                  IF known = word THEN slots[(next - 1) % EventSlots][word] ELSE seen[known]]
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, event_ring, reader, next, got, lost>>

CheckEvent ==
  /\ reader = "event" /\ DOMAIN seen = EventWords
  /\ LET same == slots[(next - 1) % EventSlots].number = next
     IN /\ reader' = IF same THEN "event accepted" ELSE "idle"
        /\ seen' = IF same THEN seen ELSE Nothing
        /\ got' = IF same THEN got + 1 ELSE got
        /\ lost' = IF same THEN lost ELSE lost + 1
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, event_ring, next>>

Use ==
  /\ reader \in {"snapshot accepted", "event accepted"}
  /\ reader' = "idle" /\ seen' = Nothing
  /\ UNCHANGED <<kernel, private, app_region, shared_tail, snapshot, event_ring, next, got, lost>>

AppStep ==
  \/ PutWord /\ Met("PutWord")
  \/ PutDone /\ Met("PutDone")
  \/ ReadLock /\ Met("ReadLock")
  \/ ReadWord /\ Met("ReadWord")
  \/ CheckLock /\ Met("CheckLock")
  \/ FindEvent /\ Met("FindEvent")
  \/ ReadEventWord /\ Met("ReadEventWord")
  \/ CheckEvent /\ Met("CheckEvent")
  \/ Use /\ Met("Use")

Next == KernelStep \/ AppStep
Spec == Init /\ [][Next]_vars

\* ---- Properties ----
\* A reader never accepts a torn snapshot: all words are of one tick, the one that its lock names.
K1_whole_snapshot ==
  reader = "snapshot accepted" => seen["first"] = seen["second"] /\ seen["first"] # 0

\* A reader never accepts a torn event, nor one event for another.
K2_whole_event == reader = "event accepted" => \A word \in EventWords : seen[word] = next

\* Each event is received once or counted as lost.
K3_events_accounted == reader # "event" => next = got + lost

\* What is used passed its checks on the very copy that is used.
K4_used_is_sound == verdict.used => IsSound(verdict.record) /\ verdict.newer

\* No request of an old attachment is used.
K5_used_is_current == verdict.used => verdict.from = generation

\* Each copied record gets at most one verdict.
K6_one_verdict == ~verdict.again

\* A tick's work is bounded, whatever the app writes.
K7_bounded_work == work <= 1 + PerTick * 3

\* Nothing that the app does or leaves undone keeps the kernel from its next step.
K8_never_waits == tick < Ticks => ENABLED KernelStep

\* An honest app's requests are all used, in its order, and none is overwritten before it was read.
K9_honest_is_served == ~Lying /\ kernel = "event number" => verdict.used /\ verdict.record = Honest(taken - Len(batch))

\* ---- What the properties are about does happen: each says so ----
About ==
  [](/\ reader = "snapshot accepted" => Met("K1_whole_snapshot")
     /\ reader = "event accepted" => Met("K2_whole_event")
     /\ lost > 0 => Met("K3_events_accounted")
     /\ verdict.used => Met("K4_used_is_sound")
     /\ verdict.used /\ generation > 1 => Met("K5_used_is_current")
     /\ kernel = "event number" /\ taken > 1 => Met("K6_one_verdict")
     /\ work = 1 + PerTick * 3 => Met("K7_bounded_work")
     /\ tick = Ticks /\ kernel = "begin" => Met("K8_never_waits")
     /\ verdict.used /\ verdict.record.sequence > Ring => Met("K9_honest_is_served"))
=============================================================================
