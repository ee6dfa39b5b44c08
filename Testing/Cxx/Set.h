// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Set.h
 * @brief Filters and options with what is set in them, in one statement.
 *
 *     TAUTLINE_LET(WarpOptions, options, method = WarpMethod::Femwarp, threads = 1);
 *     TAUTLINE_NEW(vtkMeshWarp, filter, SetInputData(grid), SetAngle(60), Update());
 *     TAUTLINE_SET(filter, SetAngle(70), Update());
 */
#ifndef tautline_Set_h
#define tautline_Set_h

namespace tautline
{
/** The target of a pointer. */
template <class T>
auto setIn(T&& pointer, int) -> decltype(*pointer)
{
  return *pointer;
}

template <class T>
T& setIn(T& object, long)
{
  return object;
}
}

/** Calls functions or sets members of an object, or of what a pointer points to: up to 14, in the
    order given. */
#define TAUTLINE_SET(object, ...)                                                                  \
  TAUTLINE_FOURTEENTH(__VA_ARGS__, TAUTLINE_SET14, TAUTLINE_SET13, TAUTLINE_SET12, TAUTLINE_SET11, \
    TAUTLINE_SET10, TAUTLINE_SET9, TAUTLINE_SET8, TAUTLINE_SET7, TAUTLINE_SET6, TAUTLINE_SET5,     \
    TAUTLINE_SET4, TAUTLINE_SET3, TAUTLINE_SET2, TAUTLINE_SET1, )                                  \
  (object, __VA_ARGS__)
/** A variable of a type, with members that are set as by TAUTLINE_SET. */
#define TAUTLINE_LET(type, name, ...) \
  type name;                          \
  TAUTLINE_SET(name, __VA_ARGS__)
/** A vtkNew, of which functions are called as by TAUTLINE_SET. */
#define TAUTLINE_NEW(type, name, ...) \
  vtkNew<type> name;                  \
  TAUTLINE_SET(name, __VA_ARGS__)
/** A copy of a value in which members are set as by TAUTLINE_SET. */
#define TAUTLINE_CHANGED(value, ...)              \
  (                                               \
    [&]                                           \
    {                                             \
      auto tautlineChanged = value;               \
      TAUTLINE_SET(tautlineChanged, __VA_ARGS__); \
      return tautlineChanged;                     \
    }())
/** A function that makes a VTK object, of which functions are called as by TAUTLINE_SET. */
#define TAUTLINE_MAKER(type, ...)                   \
  [=]                                               \
  {                                                 \
    const auto made = vtkSmartPointer<type>::New(); \
    TAUTLINE_SET(made, __VA_ARGS__);                \
    return made;                                    \
  }

#define TAUTLINE_FOURTEENTH(a, b, c, d, e, f, g, h, i, j, k, l, m, n, it, ...) it
#define TAUTLINE_SET1(object, a) void(tautline::setIn(object, 0).a)
#define TAUTLINE_SET2(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET1(object, __VA_ARGS__)
#define TAUTLINE_SET3(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET2(object, __VA_ARGS__)
#define TAUTLINE_SET4(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET3(object, __VA_ARGS__)
#define TAUTLINE_SET5(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET4(object, __VA_ARGS__)
#define TAUTLINE_SET6(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET5(object, __VA_ARGS__)
#define TAUTLINE_SET7(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET6(object, __VA_ARGS__)
#define TAUTLINE_SET8(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET7(object, __VA_ARGS__)
#define TAUTLINE_SET9(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET8(object, __VA_ARGS__)
#define TAUTLINE_SET10(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET9(object, __VA_ARGS__)
#define TAUTLINE_SET11(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET10(object, __VA_ARGS__)
#define TAUTLINE_SET12(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET11(object, __VA_ARGS__)
#define TAUTLINE_SET13(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET12(object, __VA_ARGS__)
#define TAUTLINE_SET14(object, a, ...) TAUTLINE_SET1(object, a), TAUTLINE_SET13(object, __VA_ARGS__)

#endif
