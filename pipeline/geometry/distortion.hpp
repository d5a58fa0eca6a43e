#pragma once

#include <array>

namespace bodyscan {

// A distorted point and its derivatives by the ideal one.
template <class Number>
struct Distorted {
  Number x;
  Number y;
  Number x_by_x;
  Number x_by_y;  // = y_by_x
  Number y_by_y;
};

// Brown's model (1966) with OpenCV's order of coefficients, in normalised coordinates.
template <class Number>
struct Distortion {
  Number k1;
  Number k2;
  Number p1;
  Number p2;
  Number k3;

  explicit Distortion(const std::array<double, 5>& c)
      : k1(static_cast<Number>(c[0])),
        k2(static_cast<Number>(c[1])),
        p1(static_cast<Number>(c[2])),
        p2(static_cast<Number>(c[3])),
        k3(static_cast<Number>(c[4])) {}

  [[gnu::always_inline]] inline Distorted<Number> operator()(Number x, Number y) const {
    const Number r2 = x * x + y * y;
    const Number radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const Number slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
            radial + x * x * slope + 2 * p1 * y + 6 * p2 * x, x * y * slope + 2 * p1 * x + 2 * p2 * y,
            radial + y * y * slope + 6 * p1 * y + 2 * p2 * x};
  }
};

}  // namespace bodyscan
