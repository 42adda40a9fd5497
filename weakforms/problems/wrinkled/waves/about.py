"""What is said of the problems ``wrinkled_linear`` and ``wrinkled_bending``."""

from weakforms.problems.about import BLOCKS, About, Example, Family
from weakforms.problems.column import Units, numbers
from weakforms.problems.wrinkled.about import BETA, CYLINDER, LEVEL, PAPER5

SHARED = {"paper": 5, "source": PAPER5, "units": Units("Ao", "C1", "h")}

WRINKLED_LINEAR = About(
    name="wrinkled_linear",
    title="Linearised theory of waves around a wrinkled cylinder",
    **SHARED,
    energy="Pi2/pi = A + n B along u = f z0', v = f, w = -f r0' (no meridional displacement), f = 0 above "
    "the level; n_star = A/(-B)",
    control="none; the quantities belong to one level and trial function",
    unknown="waves around a wrinkled cylinder: second variation of its relaxed energy for a trial function",
    forms=("forms.revolution:second_order", "forms.revolution:strain_energy"),
    numbers=(
        *CYLINDER,
        LEVEL,
        *numbers(
            A="the part of Pi2/pi that does not depend on n, over {energy}",
            B="derivative of Pi2/pi with respect to n",
            B_exact="-int p r0 f^2 (r0'^2 + z0'^2) dS",
            curved="second difference of Pi2/pi in n over its size: 0 when it is affine",
            n_star="A/(-B)",
            n_critical="real n at which the lowest eigenvalue is zero",
            n_true="smallest whole n with a negative eigenvalue",
        ),
    ),
    example=Example("zw", "n_star", values=(4.5, 5.0, 5.5), numerics={"levels": 2}),
    held_out=(Family({"zw": (4.5, 5.5), "c2": (0.005, 0.03)}, **BLOCKS),),
    missed={"n_critical": "a claim compares it with whole n, closer than 1 % is not asked"},
)

WRINKLED_BENDING = About(
    name="wrinkled_bending",
    title="Waves around a wrinkled cylinder with a small bending stiffness",
    **SHARED,
    energy="2 Pi2/pi of the membrane + int beta H^3 R k22^2 dS",
    control="none; the quantities belong to one level",
    unknown="waves (u, beta, w) of wave number n around a wrinkled cylinder",
    forms=("forms.revolution:second_order", "forms.revolution:hoop_bending"),
    numbers=(
        *CYLINDER,
        LEVEL,
        BETA,
        *numbers(
            n="wave number, real",
            Lambda_membrane="lowest eigenvalue for n waves without bending stiffness",
            Lambda_B1="lowest eigenvalue for n waves with bending stiffness",
            Lambda_B2="lowest eigenvalue for n waves with the bending energy of a shell, simply supported",
            n_minus="lower end of the band of unstable n with that stiffness",
            n_plus="upper end of this band; without bending stiffness there is none",
            beta_c="smallest stiffness at which no real n is unstable",
            n_c="last unstable n; the wavelength is 2 pi r/n_c",
        ),
    ),
    example=Example("n", "Lambda_membrane", values=(5.0, 10.0, 20.0), numerics={"levels": 2, "degree": 4}),
    held_out=(Family({"zw": (4.5, 5.5), "n": (8.0, 14.0)}, **BLOCKS, fixed={"beta": 1e-6}),),
)
