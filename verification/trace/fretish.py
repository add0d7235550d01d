"""Whether a sentence is FRETish: the language of NASA's FRET, in the part of its grammar that we use.

    [scope] [condition] the COMPONENT shall [timing] satisfy RESPONSE

From Requirement.g4 of FRET. Scope: `[when|if] [not] in NAME mode`, `unless in`, `during`, `before`, `after`.
Conditions by when, whenever, upon, if, unless and where. Every timing. Boolean expressions over names,
comparisons and sums. Without: free text, `only`, `except` and `while`, functions, products, exclusive or, and
durations in units of time: a kernel counts ticks. `when` speaks of the rising edge, `whenever` of the level.
"""

import re

TOKEN = re.compile(r"\s*(?P<word>[A-Za-z][\w.%]*|\d+|<=>|<->|=>|->|<=|>=|!=|[<>=!&|()+,~-])")
QUALIFIERS = frozenset({"when", "whenever", "upon", "if", "unless", "where"})
RESERVED = QUALIFIERS | frozenset(
    {
        *("after", "always", "and", "at", "before", "during", "eventually", "except", "false", "for", "hour"),
        *(
            "immediately",
            "in",
            "is",
            "minute",
            "mod",
            "mode",
            "never",
            "next",
            "not",
            "only",
            "or",
            "satisfy",
        ),
        *("second", "shall", "the", "then", "tick", "ticks", "timepoint", "true", "until", "while", "within"),
        "xor",
    }
)
"""Words of the language, in whatever letters: no quantity may be called so."""
COMPARISONS = frozenset({"<", "<=", ">", ">=", "=", "!="})


class FretishError(Exception):
    """A sentence that is not FRETish; the text says where, and what was expected."""


class Sentence:
    """Reads one sentence from left to right."""

    def __init__(self, text: str) -> None:
        self.words: list[str] = []
        place, end = 0, len(text.rstrip())
        while place < end:
            found = TOKEN.match(text, place)
            if not found:
                raise FretishError(f"'{text[place:].strip()[0]}' is no sign of the language")
            self.words.append(found["word"])
            place = found.end()
        self.at = 0

    def next(self) -> str:
        """The word that comes, in small letters; empty at the end."""
        return self.words[self.at].lower() if self.at < len(self.words) else ""

    def takes(self, *words: str) -> bool:
        """Whether these words come; then they are behind us."""
        coming = tuple(word.lower() for word in self.words[self.at : self.at + len(words)])
        if coming != words:
            return False
        self.at += len(words)
        return True

    def needs(self, *words: str) -> None:
        if not self.takes(*words):
            raise self.unexpected(f"'{' '.join(words)}'")

    def unexpected(self, expected: str) -> FretishError:
        found = f"'{self.words[self.at]}'" if self.at < len(self.words) else "the end"
        return FretishError(f"expected {expected}, found {found} (word {self.at + 1})")

    def name(self, what: str) -> None:
        """A name that is no word of the language."""
        if not self.next()[:1].isalpha() or self.next() in RESERVED:
            raise self.unexpected(what)
        self.at += 1

    def number(self) -> None:
        if not self.next().isdigit():
            raise self.unexpected("a number")
        self.at += 1

    def sentence(self) -> None:
        self.scope()
        while self.next() in QUALIFIERS:
            self.at += 1
            self.expression()
            self.takes(",")
        self.takes("the")
        self.name("a component")
        self.needs("shall")
        self.timing()
        self.needs("satisfy")
        self.expression()
        if self.next():
            raise self.unexpected("the end")

    def scope(self) -> None:
        """`when in` begins a scope, `when` alone a condition."""
        within = ("in",), ("during",), ("unless", "in")
        within += tuple((when, *no, "in") for when in ("when", "if") for no in ((), ("not",)))
        if any(self.takes(*words) for words in (*within, ("before",), ("after",))):
            self.name("a mode")
            self.needs("mode")
            self.takes(",")

    def timing(self) -> None:
        if any(self.takes(word) for word in ("immediately", "eventually", "always", "never")):
            return
        if self.takes("at"):
            self.needs("the", "next", "timepoint")
        elif any(self.takes(word) for word in ("within", "for", "after")):
            self.number()
            if not (self.takes("ticks") or self.takes("tick")):
                raise self.unexpected("'ticks'")
        elif any(self.takes(word) for word in ("until", "before")):
            self.expression()

    def expression(self) -> None:
        """A Boolean expression; which sign binds more tightly makes no difference to its being one."""
        self.term()
        while self.next() in ("&", "|", "=>", "->", "<=>", "<->"):
            self.at += 1
            self.term()

    def term(self) -> None:
        if self.takes("!") or self.takes("~"):
            self.term()
        elif self.takes("true") or self.takes("false"):
            return
        elif self.is_bracketed_expression():
            self.needs("(")
            self.expression()
            self.needs(")")
        else:
            self.sum()
            if self.next() in COMPARISONS:
                self.at += 1
                self.sum()

    def is_bracketed_expression(self) -> bool:
        """Whether what comes in brackets is compared with nothing after them."""
        depth = 0
        for place in range(self.at, len(self.words)):
            depth += {"(": 1, ")": -1}.get(self.words[place], 0)
            if depth == 0:
                after = self.words[place + 1] if place + 1 < len(self.words) else ""
                return place > self.at and after not in COMPARISONS | {"+", "-"}
        return False

    def sum(self) -> None:
        while True:
            if self.takes("("):
                self.sum()
                self.needs(")")
            elif self.next().isdigit():
                self.number()
            else:
                self.name("a quantity")
            if not (self.takes("+") or self.takes("-")):
                return


def check(text: str) -> None:
    """Raises FretishError for a sentence that is not FRETish."""
    Sentence(text).sentence()
