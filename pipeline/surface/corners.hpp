#pragma once

// Which corners and sides of a cell its triangles use: 0 or 1, from the cell's byte (cells.hpp).
namespace bodyscan::corners {

[[gnu::always_inline]] inline unsigned first(unsigned code) {
  return code & 1U;
}
[[gnu::always_inline]] inline unsigned second(unsigned code) {
  return code >> 1 & 1U;
}
[[gnu::always_inline]] inline unsigned anti(unsigned code) {
  return code >> 2 & 1U;
}

[[gnu::always_inline]] inline unsigned a(unsigned code) {
  return first(code) | (second(code) & ~anti(code));
}
[[gnu::always_inline]] inline unsigned b(unsigned code) {
  return second(code) | (first(code) & anti(code));
}
[[gnu::always_inline]] inline unsigned c(unsigned code) {
  return first(code) | (second(code) & anti(code));
}
[[gnu::always_inline]] inline unsigned d(unsigned code) {
  return second(code) | (first(code) & ~anti(code));
}

[[gnu::always_inline]] inline unsigned top(unsigned code) {
  return anti(code) ? first(code) : second(code);
}
[[gnu::always_inline]] inline unsigned bottom(unsigned code) {
  return anti(code) ? second(code) : first(code);
}

}  // namespace bodyscan::corners
