"""A free rigid body on a bed of stiff springs over a moving surface: an oracle for parts with a face.

It shares nothing with the program but the definition of the pose. The body has six degrees of freedom and nothing is
linearised: a state is the place of its centre of mass, a unit quaternion, and the velocities of both, the angular one
in body axes. The face has nine Gauss points P_k with weights g_k. With the foot of P_k on the mid-plane, by Newton's
method, and the normal n there, the gap over the plate's face at the height zk is n.(P_k - foot) - zk. Springs k = m
om^2 and dampers c = 2 zeta m om press with s_k = -(k gap + c gap'):

    "raw"     p_k = g_k s_k. A flat face on a curved surface leaves gaps whatever the load: this has no stiff limit.
    "affine"  p_k = g_k times the affine fit of s over the face, which feels the mean gap and its moments only.

`rim` puts twelve points in place of the nine on a square's rim, that far from its centre.

The surface pushes with p_k n - mu p_k u/sqrt(|u|^2 + eps^2) at P_k, u the tangential part of the point's velocity less
(0, 0, w_t) and zk n_t. The start is the pose of (X, Y, theta) and its rate, corrected so that the gaps have no rates.
"""

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

G0 = 9.80665
SQUARE, BAR = (100e-6, 100e-6), (200e-6, 50e-6)
PLATE = dict(kind="plate", a=1e-3, sources=[[-3e-4, 0.0], [3e-4, 0.0]], f=120.0, phases=[0.0, np.pi / 2])
A = dict(
    surface=dict(PLATE, stroke=20e-6), face=SQUARE, mu=0.02, start=[1e-4, 2e-4, 0.3], rate=[0.0, 0.0, 0.0], end=0.02
)
CASES = dict(
    A20=A,
    A5=dict(A, surface=dict(PLATE, stroke=5e-6)),
    B=dict(
        surface=dict(kind="quadric", qx=100.0, qy=100.0),
        face=SQUARE,
        mu=0.1,
        start=[2e-4, 0.0, 0.2],
        rate=[0.005, 0.02, 100.0],
        end=0.1,
    ),
    C=dict(
        surface=dict(kind="quadric", qx=150.0, qy=-150.0),
        face=BAR,
        mu=0.1,
        start=[1e-4, 5e-5, 0.5],
        rate=[0.01, -0.01, -50.0],
        end=0.01,
    ),
)
for _c in CASES.values():
    _c.update(thickness=50e-6, density=2330.0, h=25e-6, zk=10e-6)


@njit(cache=True)
def boggio(x, y, sx, sy, a):
    """Clamped disc, point load at s: G = D ln(D/A) + A - D (in units of a) and its x, y, xx, xy, yy derivatives."""
    x, y, sx, sy = x / a, y / a, sx / a, sy / a
    D, ss = (x - sx) ** 2 + (y - sy) ** 2, sx * sx + sy * sy
    q = 1.0 - 2.0 * (x * sx + y * sy) + (x * x + y * y) * ss
    if D == 0.0:
        return q, 0.0, 0.0, 0.0, 0.0, 0.0
    L, e = np.log(D / q), 1.0 - D / q
    D1, D2, A1, A2 = 2 * (x - sx), 2 * (y - sy), 2 * (x * ss - sx), 2 * (y * ss - sy)
    xx = 2 * L + D1 * D1 / D - 2 * D1 * A1 / q + 2 * ss * e + A1 * A1 * D / q**2
    yy = 2 * L + D2 * D2 / D - 2 * D2 * A2 / q + 2 * ss * e + A2 * A2 * D / q**2
    xy = D1 * D2 / D - (D1 * A2 + A1 * D2) / q + A1 * A2 * D / q**2
    return D * L + q - D, (D1 * L + A1 * e) / a, (D2 * L + A2 * e) / a, xx / a**2, xy / a**2, yy / a**2


@njit(cache=True)
def surface(sp, x, y, t):
    """w, w_x, w_y, w_xx, w_xy, w_yy, w_t, w_xt, w_yt; sp: [0, qx, qy] or [1, a, f, stroke, ph1, ph2, s1, s2, C(4)]."""
    o, a, b = np.zeros(9), sp[1], sp[2]
    if sp[0] == 0.0:
        o[0], o[1], o[2], o[3], o[5] = a * x * x + b * y * y, 2 * a * x, 2 * b * y, 2 * a, 2 * b
        return o
    W = 2 * np.pi * sp[2]
    for j in range(2):
        c = ct = 0.0
        for i in range(2):  # w = sum_i h_i phi_i, phi_i = sum_j C_ij G(., s_j)
            c += 0.5 * sp[3] * (1 - np.cos(W * t + sp[4 + i])) * sp[10 + 2 * i + j]
            ct += 0.5 * sp[3] * W * np.sin(W * t + sp[4 + i]) * sp[10 + 2 * i + j]
        g = boggio(x, y, sp[6 + 2 * j], sp[7 + 2 * j], sp[1])
        for d in range(6):
            o[d] += c * g[d]
        for d in range(3):
            o[6 + d] += ct * g[d]
    return o


@njit(cache=True)
def rot(q):
    w, x, y, z = q / np.sqrt(np.sum(q * q))
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@njit(cache=True)
def contact(t, y, sp, b, pts, g):
    """Per face point: gap, gap rate, tangential slip u(3), normal n(3), arm in body axes (3)."""
    h, zk = b[4], b[5]
    R = rot(y[3:7])
    out = np.empty((len(g), 11))
    for k in range(len(g)):
        r = np.array([pts[k, 0], pts[k, 1], -h])
        P, v = y[:3] + R @ r, y[7:10] + R @ np.cross(y[10:13], r)
        fx, fy = P[0], P[1]
        s = surface(sp, fx, fy, t)
        for _ in range(30):  # (P - foot) parallel to n
            d = P[2] - s[0]
            F1, F2 = P[0] - fx + s[1] * d, P[1] - fy + s[2] * d
            a11, a12, a22 = s[3] * d - 1 - s[1] ** 2, s[4] * d - s[1] * s[2], s[5] * d - 1 - s[2] ** 2
            det = a11 * a22 - a12 * a12
            dx, dy = -(a22 * F1 - a12 * F2) / det, -(a11 * F2 - a12 * F1) / det
            fx, fy = fx + dx, fy + dy
            s = surface(sp, fx, fy, t)
            if abs(dx) + abs(dy) < 1e-17:
                break
        L = np.sqrt(1 + s[1] ** 2 + s[2] ** 2)
        n, nt = np.array([-s[1], -s[2], 1.0]) / L, np.array([-s[7], -s[8], 0.0]) / L
        nt -= n * np.dot(n, nt)
        rel = v - np.array([0.0, 0.0, s[6]])
        rate = np.dot(n, rel)
        out[k, 0] = (P[0] - fx) * n[0] + (P[1] - fy) * n[1] + (P[2] - s[0]) * n[2] - zk
        out[k, 1], out[k, 2:5], out[k, 5:8], out[k, 8:11] = rate, rel - rate * n - zk * nt, n, r
    return out


@njit(cache=True)
def affine(v, pts, g):
    """Weighted least-squares fit c0 + c1 x + c2 y (the point set is symmetric: normal equations are diagonal)."""
    x, y = pts[:, 0], pts[:, 1]
    return np.array([np.sum(g * v), np.sum(g * x * v) / np.sum(g * x * x), np.sum(g * y * v) / np.sum(g * y * y)])


@njit(cache=True)
def pressures(c, b, pts, g):
    s = -(b[7] * c[:, 0] + b[8] * c[:, 1])
    if b[10] == 1.0:
        f = affine(s, pts, g)
        s = f[0] + f[1] * pts[:, 0] + f[2] * pts[:, 1]
    return g * s


@njit(cache=True)
def rhs(t, y, sp, b, pts, g):
    """b = [m, J1, J2, J3, h, zk, mu, k, c, eps, affine?]."""
    c = contact(t, y, sp, b, pts, g)
    p = pressures(c, b, pts, g)
    R, F, M, o, J, q, d = rot(y[3:7]), np.zeros(3), np.zeros(3), y[10:13], b[1:4], y[3:7], np.empty(13)
    for k in range(len(g)):
        u = c[k, 2:5]
        f = p[k] * (c[k, 5:8] - b[6] * u / np.sqrt(np.dot(u, u) + b[9] ** 2))
        F += f
        M += np.cross(c[k, 8:11], R.T @ f)
    d[:3] = y[7:10]
    d[3] = -0.5 * (q[1] * o[0] + q[2] * o[1] + q[3] * o[2])
    d[4:7] = 0.5 * (q[0] * o + np.cross(q[1:4], o))
    d[7:10] = F / b[0]
    d[9] -= G0
    d[10:13] = (M - np.cross(o, J * o)) / J
    return d


@njit(cache=True)
def jac(t, y, sp, b, pts, g):
    """Central differences; steps for velocities well inside the friction's eps."""
    Jm = np.empty((13, 13))
    for i in range(13):
        e = 1e-12 if i < 3 else 1e-8 if i < 7 else b[9] * 1e-2 if i < 10 else b[9] * 100.0
        hi, lo = y.copy(), y.copy()
        hi[i], lo[i] = y[i] + e, y[i] - e
        Jm[:, i] = (rhs(t, hi, sp, b, pts, g) - rhs(t, lo, sp, b, pts, g)) / (hi[i] - lo[i])
    return Jm


def frame(half, wall, slit=1e-8):
    """The corners (12, 2) [m] of a square's rim, a wall wide, as one polygon with a slit."""
    outer, inner, side = half, half - wall, slit / 2
    around = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    ends = [[(a, side), *(np.array(around) * a), (a, -side)] for a in (outer, inner)]
    return np.array([*ends[0], *ends[1][::-1]])


def qmul(p, q):
    return np.r_[p[0] * q[0] - p[1:] @ q[1:], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])]


class Body:
    def __init__(self, case, om, eps, bed="affine", zeta=1.0, rim=None):
        c = self.case = CASES[case]
        (a, bb), d = c["face"], c["thickness"]
        m = c["density"] * a * bb * d
        J = m / 12 * np.array([bb**2 + d**2, a**2 + d**2, a**2 + bb**2])
        self.b = np.r_[m, J, c["h"], c["zk"], c["mu"], m * om**2, 2 * zeta * m * om, eps, float(bed == "affine")]
        x, wt = np.polynomial.legendre.leggauss(3)
        self.pts = np.array([[a / 2 * u, bb / 2 * v] for u in x for v in x])
        self.g = np.array([u * v for u in wt for v in wt]) / 4
        if rim is not None:
            self.pts = rim * np.array([point for u in x for point in ((1, u), (-1, u), (u, 1), (u, -1))])
            self.g = np.repeat(wt, 4) / 8
        s = c["surface"]
        if s["kind"] == "quadric":
            self.sp = np.array([0.0, s["qx"], s["qy"]])
        else:
            S = np.array(s["sources"])
            GG = np.array(
                [[boggio(*S[i], *S[j], s["a"])[0] for i in range(2)] for j in range(2)]
            )  # GG[j, i] = G(s_i, s_j)
            self.sp = np.r_[1.0, s["a"], s["f"], s["stroke"], s["phases"], S.ravel(), np.linalg.inv(GG).ravel()]
        self.args = (self.sp, self.b, self.pts, self.g)

    def plane(self, X, Y, th, t):
        """zet, gam of the least-squares plane under the footprint."""
        cs, sn = np.cos(th), np.sin(th)
        w = [surface(self.sp, X + cs * u - sn * v, Y + sn * u + cs * v, t)[0] for u, v in self.pts]
        return affine(np.array(w), self.pts, self.g)

    def pose(self, X, Y, th, t):
        """CoM position and quaternion of the body that lies on that plane."""
        zet, g1, g2 = self.plane(X, Y, th, t)
        nu = np.array([-g1, -g2, 1.0]) / np.sqrt(1 + g1**2 + g2**2)
        T = np.r_[1 + nu[2], -nu[1], nu[0], 0.0]  # least rotation z -> nu: (1 + z.nu, z x nu)
        q = qmul(np.r_[np.cos(th / 2), 0, 0, np.sin(th / 2)], T / np.linalg.norm(T))
        return np.r_[np.r_[X, Y, zet] + (self.b[5] + self.b[4]) * rot(q)[:, 2], q]

    def coords(self, y, t):
        """(X, Y, theta) of a state: swing-twist for theta, then (X, Y) + zk (Rz nu(X, Y, theta))_xy = face origin."""
        th = 2 * np.arctan2(y[6], y[3])
        origin = y[:3] - self.b[4] * rot(y[3:7])[:, 2]
        X, Y = origin[:2]
        for _ in range(20):
            X, Y = origin[:2] - self.b[5] * rot(self.pose(X, Y, th, t)[3:])[:2, 2]
        return np.array([X, Y, th])

    def start(self):
        c, d, L = self.case, 1e-7, 0.5 * self.case["face"][0]
        q0, v0 = np.array(c["start"]), np.array(c["rate"])
        s0, s1, s2 = (self.pose(*(q0 + v0 * e), e) for e in (0.0, d, -d))
        ds = (s1 - s2) / (2 * d)
        y0 = np.r_[s0, ds[:3], 2 * qmul(s0[3:] * [1, -1, -1, -1], ds[3:])[1:]]

        def state(u):  # u: heave, 2 tilts (length at the rim), rates
            y = y0.copy()
            y[3:7] = qmul(y0[3:7], np.r_[1.0, 0.5 * u[1] / L, 0.5 * u[2] / L, 0.0])
            y[:3] += (self.b[4] + u[0]) * rot(y[3:7])[:, 2] - self.b[4] * rot(y0[3:7])[:, 2]
            y[10:12] += u[4:6] / L
            y[7:10] += rot(y[3:7]) @ (np.cross(np.r_[u[4:6] / L, 0.0], np.r_[0, 0, self.b[4]]) + np.r_[0, 0, u[3]])
            return y

        def rates(y, t):
            return affine(contact(t, y, *self.args)[:, 1], self.pts, self.g) * [1, L, L]

        def res(u):  # affine gap rates, and their rates along the flow
            y, e, f = state(u), 1e-9, rhs(0.0, state(u), *self.args)
            return np.r_[rates(y, 0.0), (rates(y + e * f, e) - rates(y - e * f, -e)) / (2 * e)]

        u, du = np.zeros(6), np.r_[[1e-3 * G0 * self.b[0] / self.b[7]] * 3, [1e-6] * 3]
        for _ in range(8):  # Newton
            r = res(u)
            u = u - np.linalg.solve(np.array([(res(u + np.eye(6)[i] * du[i]) - r) / du[i] for i in range(6)]).T, r)
        return state(u)

    def run(self, rtol=1e-8):
        """The path, by scipy's Radau."""
        atol = np.r_[[1e-6] * 3, [1e-2] * 4, [1e-4] * 3, [1.0] * 3] * rtol
        return solve_ivp(
            lambda t, y: rhs(t, y, *self.args),
            (0.0, self.case["end"]),
            self.start(),
            method="Radau",
            jac=lambda t, y: jac(t, y, *self.args),
            rtol=rtol,
            atol=atol,
            first_step=1e-8,
        )
