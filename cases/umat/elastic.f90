! Isotropic linear elasticity as a UMAT. PROPS: Young's modulus, Poisson's ratio.
!
!     gfortran -O2 -shared -fPIC -o libelastic.so elastic.f90
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, &
                celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
    implicit none
    integer, parameter :: real64 = kind(1.0d0)
    integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
    character(80) :: cmname
    real(real64) :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), &
        drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), &
        props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
    real(real64) :: lambda, shear, mean, deviator(ntens)
    integer :: i

    if (nprops /= 2) then
        call stdb_abqerr(-3, 'elastic takes 2 numbers, not %I', nprops, 0.0d0, ' ')
    end if
    shear = 0.5d0 * props(1) / (1 + props(2))
    lambda = props(1) * props(2) / ((1 + props(2)) * (1 - 2 * props(2)))

    ddsdde = 0
    ddsdde(1:ndi, 1:ndi) = lambda
    do i = 1, ntens
        ddsdde(i, i) = ddsdde(i, i) + merge(2, 1, i <= ndi) * shear
    end do
    stress = stress + matmul(ddsdde, dstran)

    mean = sum(stress(1:3)) / 3
    deviator = stress
    deviator(1:3) = stress(1:3) - mean
    sse = 0.5d0 * mean**2 / (lambda + 2 * shear / 3) &
        + 0.25d0 * (sum(deviator(1:3)**2) + 2 * sum(deviator(4:ntens)**2)) / shear
end subroutine umat
