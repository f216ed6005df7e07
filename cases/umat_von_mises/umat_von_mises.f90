! SPDX-License-Identifier: GPL-3.0-or-later
! Von Mises plasticity with linear isotropic hardening as an Abaqus UMAT: Hooke's law in rate form,
! radial return (Simo, Hughes, Computational Inelasticity, section 3.3), consistent tangent.
!   PROPS:  E, nu, yield stress of a uniaxial test, its slope over the plastic strain
!   STATEV: (1) equivalent plastic strain
! For three-dimensional, plane strain and axisymmetric elements: NDI = 3, NSHR = 1 or 3. STRESS
! comes turned with the material, so that nothing is left to do with DROT.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
                nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, &
                kstep, kinc)
  implicit none
  integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
  double precision, intent(inout) :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens)
  double precision, intent(inout) :: sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), drpldt, pnewdt
  double precision, intent(in) :: stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp
  double precision, intent(in) :: predef(*), dpred(*), props(nprops), coords(3), drot(3, 3), celent
  double precision, intent(in) :: dfgrd0(3, 3), dfgrd1(3, 3)
  character(len=80), intent(in) :: cmname
  double precision :: shear, lambda, mean, dev(6), q, over, flow, keep, along
  integer :: i, j

  if (nprops /= 4 .or. nstatv /= 1) stop 'umat_von_mises needs 4 constants and 1 state variable'
  shear = props(1) / (2 * (1 + props(2)))
  lambda = 2 * shear * props(2) / (1 - 2 * props(2))

  ! trial stress; shear strains are engineering ones
  stress(1:ndi) = stress(1:ndi) + lambda * sum(dstran(1:ndi)) + 2 * shear * dstran(1:ndi)
  stress(ndi+1:ntens) = stress(ndi+1:ntens) + shear * dstran(ndi+1:ntens)
  mean = sum(stress(1:ndi)) / 3
  dev(1:ntens) = stress
  dev(1:ndi) = dev(1:ndi) - mean
  q = sqrt(1.5d0 * sum(dev(1:ndi)**2) + 3 * sum(dev(ndi+1:ntens)**2))

  ! return to the yield surface along the deviator
  over = q - props(3) - props(4) * statev(1)
  flow = 0
  keep = 1
  along = 0
  if (over > 0) then
    flow = over / (3 * shear + props(4))
    keep = 1 - 3 * shear * flow / q
    along = 3 * shear * (keep - props(4) / (3 * shear + props(4))) / q**2
  end if
  stress = keep * dev(1:ntens)
  stress(1:ndi) = stress(1:ndi) + mean
  statev(1) = statev(1) + flow

  do j = 1, ntens
    do i = 1, ntens
      ddsdde(i, j) = -along * dev(i) * dev(j)
      if (i <= ndi .and. j <= ndi) ddsdde(i, j) = ddsdde(i, j) + lambda + shear * (1 - keep) * 2 / 3
      if (i == j .and. i <= ndi) ddsdde(i, j) = ddsdde(i, j) + 2 * shear * keep
      if (i == j .and. i > ndi) ddsdde(i, j) = ddsdde(i, j) + shear * keep
    end do
  end do
end subroutine umat

! The same in logarithmic strain, from the deformation gradient (Simo, Comput. Methods Appl. Mech.
! Engrg 99 (1992) 61-112): exact for any rotation and stretch of an increment. PROPS as above.
! STATEV: 1 plastic strain, 2-7 elastic left Cauchy-Green tensor (zeros: free of stress).
! DDSDDE is 1/J times the change of the Kirchhoff stress with a further strain of DFGRD1, as Abaqus
! defines it for finite strain: ddsdde_measure: kirchhoff.
subroutine umat_hencky(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, &
                       dstran, time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, &
                       nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, &
                       npt, layer, kspt, kstep, kinc)
  implicit none
  integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
  double precision, intent(inout) :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens)
  double precision, intent(inout) :: sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), drpldt, pnewdt
  double precision, intent(in) :: stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp
  double precision, intent(in) :: predef(*), dpred(*), props(nprops), coords(3), drot(3, 3), celent
  double precision, intent(in) :: dfgrd0(3, 3), dfgrd1(3, 3)
  character(len=80), intent(in) :: cmname
  integer, parameter :: row(6) = [1, 2, 3, 1, 1, 2], col(6) = [1, 2, 3, 2, 3, 3]
  double precision, parameter :: unit(3, 3) = reshape([1d0, 0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 0d0, 1d0], [3, 3])
  double precision :: shear, bulk, b(3, 3), f(3, 3), axes(3, 3), strain(3), size(3, 3), jac
  double precision :: dev(3), q, over, flow, keep, along, x, e(3, 3), s(3, 3), change(3, 3)
  integer :: i, k

  if (nprops /= 4 .or. nstatv /= 7 .or. ntens /= 6) stop 'umat_hencky needs 4 constants and 7 state variables'
  shear = props(1) / (2 * (1 + props(2)))
  bulk = props(1) / (3 * (1 - 2 * props(2)))
  b = unit
  if (any(statev(2:7) /= 0)) then
    do k = 1, 6
      b(row(k), col(k)) = statev(k + 1)
      b(col(k), row(k)) = statev(k + 1)
    end do
  end if

  ! elastic trial: the increment moves b; return in its axes
  f = matmul(dfgrd1, inverse(dfgrd0))
  b = matmul(f, matmul(b, transpose(f)))
  call principal(b, strain, axes)
  strain = log(strain) / 2
  jac = exp(sum(strain))
  dev = 2 * shear * (strain - sum(strain) / 3)
  q = sqrt(1.5d0 * sum(dev**2))
  over = q - props(3) - props(4) * statev(1)
  flow = 0
  keep = 1
  along = 0
  if (over > 0) then
    flow = over / (3 * shear + props(4))
    keep = 1 - 3 * shear * flow / q
    along = 3 * shear * (keep - props(4) / (3 * shear + props(4))) / q**2
  end if
  statev(1) = statev(1) + flow

  ! derivative of ln(b)/2 by a strain in the axes
  do i = 1, 3
    do k = 1, 3
      x = strain(i) - strain(k)
      size(i, k) = 1
      if (abs(x) > 1d-4) size(i, k) = x / tanh(x)
      if (abs(x) <= 1d-4) size(i, k) = 1 + x**2 / 3
    end do
  end do
  do k = 1, 6
    e = 0
    e(row(k), col(k)) = 0.5d0
    e(col(k), row(k)) = e(col(k), row(k)) + 0.5d0
    e = size * matmul(transpose(axes), matmul(e, axes))
    x = e(1, 1) + e(2, 2) + e(3, 3)
    change = 2 * shear * keep * (e - x / 3 * unit) + bulk * x * unit
    do i = 1, 3
      change(i, i) = change(i, i) - along * dev(i) * sum(dev * [e(1, 1), e(2, 2), e(3, 3)])
    end do
    change = matmul(axes, matmul(change, transpose(axes)))
    ddsdde(:, k) = [(change(row(i), col(i)) / jac, i = 1, 6)]
  end do

  ! stress and elastic strain at the end
  s = 0
  b = 0
  do i = 1, 3
    s(i, i) = (keep * dev(i) + bulk * sum(strain)) / jac
    b(i, i) = exp(2 * (keep * dev(i) / (2 * shear) + sum(strain) / 3))
  end do
  s = matmul(axes, matmul(s, transpose(axes)))
  b = matmul(axes, matmul(b, transpose(axes)))
  stress = [(s(row(k), col(k)), k = 1, 6)]
  statev(2:7) = [(b(row(k), col(k)), k = 1, 6)]

contains

  pure function inverse(a) result(c)
    double precision, intent(in) :: a(3, 3)
    double precision :: c(3, 3)
    integer :: m, n, m1, m2, n1, n2
    do m = 1, 3
      do n = 1, 3
        m1 = modulo(m, 3) + 1
        m2 = modulo(m + 1, 3) + 1
        n1 = modulo(n, 3) + 1
        n2 = modulo(n + 1, 3) + 1
        c(n, m) = a(m1, n1) * a(m2, n2) - a(m1, n2) * a(m2, n1)
      end do
    end do
    c = c / sum(a(1, :) * c(:, 1))
  end function inverse

  ! Principal values and their directions (columns) by Jacobi's rotations.
  pure subroutine principal(a, value, vector)
    double precision, intent(in) :: a(3, 3)
    double precision, intent(out) :: value(3), vector(3, 3)
    double precision :: m(3, 3), turn(3, 3), t
    integer :: sweep, n, p, r
    m = a
    vector = unit
    do sweep = 1, 12
      if (abs(m(1, 2)) + abs(m(1, 3)) + abs(m(2, 3)) <= 1d-20 * (m(1, 1) + m(2, 2) + m(3, 3))) exit
      do n = 1, 3
        p = min(n, modulo(n, 3) + 1)
        r = max(n, modulo(n, 3) + 1)
        if (m(p, r) == 0) cycle
        t = (m(r, r) - m(p, p)) / (2 * m(p, r))
        t = sign(1d0, t) / (abs(t) + sqrt(t**2 + 1))
        turn = unit
        turn(p, p) = 1 / sqrt(1 + t**2)
        turn(r, r) = turn(p, p)
        turn(p, r) = t * turn(p, p)
        turn(r, p) = -turn(p, r)
        m = matmul(transpose(turn), matmul(m, turn))
        vector = matmul(vector, turn)
      end do
    end do
    value = [m(1, 1), m(2, 2), m(3, 3)]
  end subroutine principal
end subroutine umat_hencky
