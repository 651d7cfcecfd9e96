! The interface as Fortran sees it, through iso_c_binding: the statistics of a small height map and a refused call.
program from_fortran
  use, intrinsic :: iso_c_binding
  implicit none

  type, bind(c) :: heights_type
    integer(c_size_t) :: struct_size
    type(c_ptr) :: values
    integer(c_int64_t) :: nx, ny, stride_x, stride_y
    integer(c_int32_t) :: detrend, reserved
  end type

  type, bind(c) :: statistics_type
    integer(c_size_t) :: struct_size
    real(c_double) :: sa, sq, ssk, sku, sp, sv, sz, sdq
  end type

  interface
    function brn_height_statistics(heights, dx, dy, statistics) bind(c) result(status)
      import :: heights_type, statistics_type, c_double, c_int32_t
      type(heights_type), intent(in) :: heights
      real(c_double), value :: dx, dy
      type(statistics_type), intent(inout) :: statistics
      integer(c_int32_t) :: status
    end function
    function brn_engine_create(options, engine) bind(c) result(status)
      import :: c_ptr, c_int32_t
      type(c_ptr), value :: options
      type(c_ptr), intent(out) :: engine
      integer(c_int32_t) :: status
    end function
    subroutine brn_engine_destroy(engine) bind(c)
      import :: c_ptr
      type(c_ptr), value :: engine
    end subroutine
    function brn_engine_threads(engine) bind(c) result(threads)
      import :: c_ptr, c_int32_t
      type(c_ptr), value :: engine
      integer(c_int32_t) :: threads
    end function
  end interface

  real(c_double), target :: map(4, 3)
  type(heights_type) :: heights
  type(statistics_type) :: statistics
  type(c_ptr) :: engine
  integer :: i

  ! A column-major array with x first is the row-major map with x inner: ridges of +1 and -1 along y.
  do i = 1, 4
    map(i, :) = merge(1.0_c_double, -1.0_c_double, mod(i, 2) == 0)
  end do
  heights = heights_type(c_sizeof(heights), c_loc(map), 4, 3, 0, 0, 1, 0)
  statistics = statistics_type(c_sizeof(statistics), 0, 0, 0, 0, 0, 0, 0, 0)
  if (brn_height_statistics(heights, 1.0_c_double, 1.0_c_double, statistics) /= 0) stop 1
  if (abs(statistics%sa - 1.0_c_double) > 1e-14_c_double) stop 2
  if (abs(statistics%sz - 2.0_c_double) > 1e-14_c_double) stop 3

  heights%nx = 0
  if (brn_height_statistics(heights, 1.0_c_double, 1.0_c_double, statistics) /= 10) stop 4

  if (brn_engine_create(c_null_ptr, engine) /= 0) stop 5
  if (brn_engine_threads(engine) < 1) stop 6
  call brn_engine_destroy(engine)
  print '(a, f4.1)', 'Sa of the ridges: ', statistics%sa
end program
