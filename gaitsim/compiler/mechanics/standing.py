"""Vertical joints whose height at the start follows from the load on the ground."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from gaitsim.compiler.mechanics.making import Made
from gaitsim.compiler.mechanics.places import Lift
from gaitsim.errors import Faults
from gaitsim.model import Model


def check_loads(model: Model, values: Sequence[float], made: Made) -> None:
    """Check that the height of each joint that starts with a load can follow from it.

    Args:
        model: The model.
        values: All numbers of the model, in SI.
        made: What the parts made.

    Raises:
        InvalidSpec: `initial:` sets the height as well, there is no contact, or MuJoCo computes the force of one.
    """
    faults = Faults()
    for lift in (lift for lift in made.lifts if lift.load > 0):
        part = model.parts[lift.part]
        for address in _heights(model, made, lift):
            index = model.initial[address]
            rule = (
                f"{model.numbers[index].unit.shown(values[index])} is set here, but {part.address} starts with load: "
            )
            rule += f"{lift.load:g}, from which this height follows; remove one of them."
            faults.add(rule, model.numbers[index].mark, address)
        if not model.simulate.gravity:
            rule = f"load is {lift.load:g}, but without gravity there is no weight to carry; remove load, or write "
            faults.add(f"{rule}simulate: {{gravity: 9.81 m/s^2}}.", model.place(part), part.address)
        elif not made.carried:
            rule = f"load is {lift.load:g}, but no part touches the ground; add a contact, or remove load."
            faults.add(rule, model.place(part), part.address)
        if made.collided:
            contact = model.parts[made.collided[0]]
            rule = f"load is {lift.load:g}, but the force of {contact.address} ({contact.type.reference}) follows from "
            rule += "all other forces, so that it is not known at the start"
            move = (
                "choose a contact with a law of its own, such as contact/hunt_crossley, or set the height in initial:"
            )
            faults.add(f"{rule}; {move}.", model.place(part), part.address)
    faults.raise_if_any()


def _heights(model: Model, made: Made, lift: Lift) -> Iterator[str]:
    """The outputs with the height of a joint that `initial:` sets."""
    for part, tie in made.reads:
        address = f"{model.parts[part].address}.{tie.port}"
        if tie.element and tie.element.name == lift.joint and tie.field == "qpos" and address in model.initial:
            yield address
