import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, State

# MRG32k3a of L'Ecuyer (1999): two recursions of order three, whose every product is below 2^53, so
# that doubles compute them exactly and all machines and modes agree.
M1 = 4294967087.0
M2 = 4294944443.0
# The largest prime of the form 3 k + 2 below 2^26: cubing permutes the numbers below it.
PRIME = 67108859.0


def uniform(state):
    """The next number between 0 and 1, both excluded; state holds the last three of either recursion."""
    first = (1403580.0 * state[1] - 810728.0 * state[0]) % M1
    second = (527612.0 * state[5] - 1370589.0 * state[3]) % M2
    state[0], state[1], state[2] = state[1], state[2], first
    state[3], state[4], state[5] = state[4], state[5], second
    difference = first - second
    return (difference if difference > 0 else difference + M1) / (M1 + 1)


def gaussian(state):
    """A number of mean 0 and standard deviation 1, from two uniform ones (Box & Muller 1958)."""
    radius = math.sqrt(-2 * math.log(uniform(state)))
    return radius * math.cos(2 * math.pi * uniform(state))


def mixed(number, salt):
    """A permutation of the whole numbers below PRIME, one for each salt."""
    value = (number + salt) % PRIME
    for _ in range(3):
        value = (value * value % PRIME * value + salt) % PRIME
    return value


def sow(state, seed, key):
    """Seed the generator from a seed and a key; the first numbers, which are correlated, are discarded."""
    for i in range(6):
        state[i] = 1 + mixed(mixed(seed, 1.0 + i) + key, 101.0 + i)
    for _ in range(12):
        uniform(state)


class Noise(Component):
    """A signal with additive Gaussian noise; one seed gives the same noise in both modes and on any machine.

    The noise is an Ornstein-Uhlenbeck process: its autocorrelation is exp(-|t| / tau) at any step, its
    standard deviation the declared one. With tau = 0, steps are independent. Each part has independent
    noise even with the same seed, because it is keyed by the part's address. There is no noise at the first instant.
    """

    standard_deviation = Parameter(
        "*", "Standard deviation of the constant noise.", default=0, source="definition: proportional noise only"
    )
    proportional = Parameter(
        "1",
        "Standard deviation of the noise that is proportional to the signal, relative to the signal's magnitude.",
        default=0,
        bounds=(0, 10),
        source="definition: constant noise only",
    )
    correlation_time = Parameter(
        "s",
        "tau: time after which the autocorrelation of the noise has fallen to 1/e.",
        default=0.01,
        bounds=(0, 1000),
        source="definition: about the time constant of muscle activation",
    )
    seed = Parameter(
        "1",
        "Seed of the noise.",
        default=1,
        bounds=(0, 67108858),
        source="definition: any seed",
        whole=True,
    )
    signal = Input("*", "Any signal.")
    generator = State("1", "State of the random numbers.", size=6)
    sown = State("1", "1 once the generator has been seeded.")
    level = State("1", "The noise in standard deviations.")
    key = Output("1", "Key of this part's noise, from its address.")
    noisy = Output("*", "The signal plus noise.")

    in_time = Curve(
        "noisy",
        "time",
        (0, 0.5),
        "Noise of standard deviation 1 over time, for several correlation times.",
        at={"standard_deviation": 1},
        each=("correlation_time", (0.1, 0.01)),
    )

    @staticmethod
    def output(p, u, x, y):
        y.noisy = u.signal + (p.standard_deviation + p.proportional * abs(u.signal)) * x.level

    @staticmethod
    def update(p, u, x, y, dt):
        kept = math.exp(-dt / p.correlation_time) if p.correlation_time > 0 else 0.0
        if x.sown < 0.5:
            sow(x.generator, p.seed, y.key)
            x.sown = 1.0
            kept = 0.0
        x.level = kept * x.level + math.sqrt(1 - kept * kept) * gaussian(x.generator)

    @staticmethod
    def build(p, mj):
        mj.read_key("key")
