#!/usr/bin/env python3
"""Reference figures of the tube, from the finite-strain equilibrium of a ring; needs nothing but Python.

A ring of the expanded tube turns with nothing, so that the rate law integrates to Cauchy stress = C : logarithmic
strain. With R the radius before and r after, and one stretch along the axis for the whole ring,
    e_r = ln dr/dR,  e_t = ln r/R,  e_z = ln l,      d sigma_r / dr + (sigma_r - sigma_t) / r = 0,
sigma_r = -p at the bore and 0 outside, and the force along the axis is -N.

Without friction N = 0, and the force that pushes the tube over the step is the work of expanding a unit of its length.
With friction the land carries dN = phi p 2 pi a l dZ, N = 0 at the leading end, Z along the tube before deformation;
the tube above the step is squeezed by N too, which delays the feed.
"""
from math import exp, log, pi

A, B, EXPANDED, LENGTH = 50.0, 55.0, 50.5, 150.0
YOUNG, NU, PHI = 210e3, 0.3, 0.2
LAME = YOUNG * NU / ((1 + NU) * (1 - 2 * NU))
SHEAR = YOUNG / (2 * (1 + NU))
LAYERS = 40


def through(a, p, e_z):
    """Integrates through the wall by RK4: stress outside and axial force, for a bore radius and pressure."""

    def rate(R, r, s):
        e_t = log(r / R)
        e_r = (s - LAME * (e_t + e_z)) / (LAME + 2 * SHEAR)
        trace, dr = e_r + e_t + e_z, exp(e_r)
        s_t, s_z = LAME * trace + 2 * SHEAR * e_t, LAME * trace + 2 * SHEAR * e_z
        return dr, -(s - s_t) / r * dr, s_z * 2 * pi * r * dr

    h, y = (B - A) / LAYERS, [a, -p, 0.0]
    for i in range(LAYERS):
        R = A + i * h
        k1 = rate(R, y[0], y[1])
        k2 = rate(R + h / 2, y[0] + h / 2 * k1[0], y[1] + h / 2 * k1[1])
        k3 = rate(R + h / 2, y[0] + h / 2 * k2[0], y[1] + h / 2 * k2[1])
        k4 = rate(R + h, y[0] + h * k3[0], y[1] + h * k3[1])
        y = [y[j] + h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]) for j in range(3)]
    return y[1], y[2]


def ring(a, thrust):
    """Pressure and axial stretch of a ring of bore radius a under a thrust: Newton with differences."""
    p, e_z = 0.0, 0.0
    for _ in range(20):
        f = through(a, p, e_z)
        f = (f[0], f[1] + thrust)
        dp, de = through(a, p + 1e-3, e_z), through(a, p, e_z + 1e-7)
        j = [[(dp[0] - f[0]) / 1e-3, (de[0] - f[0]) / 1e-7], [(dp[1] + thrust - f[1]) / 1e-3, (de[1] + thrust - f[1]) / 1e-7]]
        det = j[0][0] * j[1][1] - j[0][1] * j[1][0]
        p -= (j[1][1] * f[0] - j[0][1] * f[1]) / det
        e_z -= (j[0][0] * f[1] - j[1][0] * f[0]) / det
        if abs(f[0]) < 1e-9 and abs(f[1]) < 1e-6:
            break
    return p, exp(e_z)


def work(steps=50):
    """Work of expanding a unit of length: Simpson over the bore radius."""
    h = (EXPANDED - A) / steps
    value = lambda a: (lambda p, l: p * 2 * pi * a * l)(*ring(a, 0.0))
    return h / 3 * sum((1 if i in (0, steps) else 4 if i % 2 else 2) * value(A + i * h) for i in range(steps + 1))


def thrusts(travels, lost, h=0.5):
    """Thrust at the top of the land for given travels of the far end, `lost` of which lies before the land."""

    def rate(N):
        p, l = ring(EXPANDED, N)
        return PHI * p * 2 * pi * EXPANDED * l

    def squeezed(N):
        # Above the step nothing holds the bore.
        return 1 - exp(-N / (YOUNG * pi * (B * B - A * A)))

    table, Z, N = [(lost, 0.0)], 0.0, 0.0
    while table[-1][0] < max(travels):
        k = rate(N)
        N, Z = N + h * rate(N + h / 2 * k), Z + h
        table.append((lost + Z + (LENGTH - lost - Z) * squeezed(N), N))
    at = lambda t: next(n0 + (n1 - n0) * (t - t0) / (t1 - t0) for (t0, n0), (t1, n1) in zip(table, table[1:]) if t1 >= t)
    return [at(t) for t in travels]


if __name__ == "__main__":
    p, l = ring(EXPANDED, 0.0)
    print(f"plateau pressure without friction      {p:.3f} N/mm2 (axial stretch {l:.6f})")
    print(f"steady force without friction          {work() / 1e3:.3f} kN")
    for lost in (6.0, 8.0, 10.0):
        a, b = thrusts((39.8, 79.8), lost)
        print(f"growth from 39.8 to 79.8, {lost:4.1f} lost    {(b - a) / 1e3:.2f} kN")
