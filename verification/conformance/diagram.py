"""A table as a decision diagram: the same function, small enough for a prover at any number of rows."""

from collections.abc import Sequence
from dataclasses import dataclass, field

NO_ROW = -(2**31) + 1
"""What a column answers for inputs that the model gave no row for."""


@dataclass(frozen=True)
class Node:
    """Chooses among `children` by the input `level`; a child is a node's index or a leaf's value."""

    level: int
    children: tuple[tuple[bool, int], ...]


@dataclass
class Diagram:
    """One output column as a function of the inputs; nodes stand after those that they choose among."""

    nodes: list[Node] = field(default_factory=list)
    root: tuple[bool, int] = (True, NO_ROW)


def reduce(leaves: Sequence[int], sizes: Sequence[int]) -> Diagram:
    """The diagram of a dense table: `leaves` in lexicographic order of inputs whose domains have `sizes`.

    Equal parts are shared, and a choice without consequence is left out.
    """
    diagram = Diagram()
    layer: list[tuple[bool, int]] = [(True, leaf) for leaf in leaves]
    for level in range(len(sizes) - 1, -1, -1):
        width = sizes[level]
        known: dict[tuple[tuple[bool, int], ...], tuple[bool, int]] = {}
        above = []
        for start in range(0, len(layer), width):
            children = tuple(layer[start : start + width])
            reference = known.get(children)
            if reference is None:
                if children.count(children[0]) == width:
                    reference = children[0]
                else:
                    reference = (False, len(diagram.nodes))
                    diagram.nodes.append(Node(level, children))
                known[children] = reference
            above.append(reference)
        layer = above
    diagram.root = layer[0]
    return diagram


def as_c(name: str, diagram: Diagram, domains: Sequence[Sequence[int]]) -> str:
    """A C function of the inputs that computes the diagram without a loop or a jump."""

    def term(reference: tuple[bool, int]) -> str:
        return f"({reference[1]})" if reference[0] else f"n{reference[1]}"

    lines = [f"static int32_t {name}(const int32_t *in) {{", "  (void)in;"]
    for index, node in enumerate(diagram.nodes):
        domain = domains[node.level]
        choice = term(node.children[-1])
        for value, child in zip(domain[-2::-1], node.children[-2::-1], strict=True):
            choice = f"in[{node.level}] == {value} ? {term(child)} : {choice}"
        lines.append(f"  const int32_t n{index} = {choice};")
    return "\n".join([*lines, f"  return {term(diagram.root)};", "}", ""])
