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
