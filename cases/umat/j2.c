/* J2 plasticity with linear isotropic hardening as a UMAT: radial return (Simo and Hughes, Computational Inelasticity, box 3.2) and
 * its consistent tangent.
 *
 * PROPS: Young's modulus, Poisson's ratio, yield stress, hardening modulus. STATEV: equivalent plastic strain.
 *
 *     cc -O2 -shared -fPIC -o libj2.so j2.c -lm
 */
#include <math.h>

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
           const int *npt, const int *layer, const int *kspt, const int *jstep, const int *kinc)
{
    const int n = *ntens;
    const double young = props[0], poisson = props[1], hardening = props[3];
    const double shear = 0.5 * young / (1.0 + poisson);
    const double lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    const double bulk = lambda + 2.0 / 3.0 * shear;

    /* The elastic trial: normal components first, then shears, whose strains are those of engineers. */
    double volume = dstran[0] + dstran[1] + dstran[2];
    for (int i = 0; i < n; i++)
        stress[i] += i < 3 ? lambda * volume + 2.0 * shear * dstran[i] : shear * dstran[i];

    /* Its deviator and the equivalent stress. */
    double s[6], square = 0.0;
    const double mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    for (int i = 0; i < n; i++) {
        s[i] = i < 3 ? stress[i] - mean : stress[i];
        square += (i < 3 ? 1.0 : 2.0) * s[i] * s[i];
    }
    const double q = sqrt(1.5 * square), yield = props[2] + hardening * statev[0];

    double left = 1.0, along = 0.0; /* what is left of the shear stiffness, and what is lost along the flow */
    if (q > yield) {
        const double dp = (q - yield) / (3.0 * shear + hardening);
        left = 1.0 - 3.0 * shear * dp / q;
        along = 3.0 * shear / (3.0 * shear + hardening) - (1.0 - left);
        for (int i = 0; i < n; i++)
            stress[i] = i < 3 ? left * s[i] + mean : left * s[i];
        statev[0] += dp;
        *spd += left * q * dp;
    }

    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double d = 0.0;
            if (i < 3 && j < 3)
                d = bulk - 2.0 / 3.0 * shear * left;
            if (i == j)
                d += (i < 3 ? 2.0 : 1.0) * shear * left;
            if (along != 0.0)
                d -= 2.0 * shear * along * s[i] * s[j] / square;
            ddsdde[i + n * j] = d;
        }

    const double deviatoric = left * left * square;
    *sse = 0.5 * mean * mean / bulk + 0.25 * deviatoric / shear;
}
