// bins-inl.h: how are boxes dropped into bins, in few instructions?
//
// Included once for each instruction set, in a namespace of its own; no include guard. Most nodes of a tree
// are small, so this is written for few instructions a bin as well as for few a primitive: the three axes are
// swept together, each in a lane of its own.

#if defined(__GNUC__) && !defined(__clang__)  // clang 14 refuses eight lanes where there is no AVX
/// A box in one register of eight, where the CPU has such: (-lower, 0, upper, 0).
struct Octet {
  using Register = float __attribute__((vector_size(32)));
  using Bits = std::int32_t __attribute__((vector_size(32)));
  Register v;

  static Octet empty() {
    constexpr float e = -kInfinity;
    return {Register{e, e, e, e, e, e, e, e}};
  }
  /// Without the item's number and its other fourth lane, which must not get into arithmetic.
  static Octet of(const Item& item) {
    Bits bits;
    std::memcpy(&bits, &item, sizeof bits);
    bits &= Bits{-1, -1, -1, 0, -1, -1, -1, 0};
    return {std::bit_cast<Register>(bits)};
  }
  static Octet of(const Histogram::Slab& slab) {
    Octet octet;
    std::memcpy(&octet, &slab, sizeof octet);
    return octet;
  }
  void store(void* to) const { std::memcpy(to, &v, sizeof v); }
  Lanes minus_lower() const { return {__builtin_shufflevector(v, v, 0, 1, 2, 3)}; }
  Lanes upper() const { return {__builtin_shufflevector(v, v, 4, 5, 6, 7)}; }
  void extend(Octet other) { v = v > other.v ? v : other.v; }
};
#else
struct Octet {
  Reach reach;
  static Octet empty() { return {}; }
  static Octet of(const Item& item) { return {item.reach()}; }
  static Octet of(const Histogram::Slab& slab) { return {{slab.minus_lower, slab.upper}}; }
  void store(void* to) const { std::memcpy(to, &reach, sizeof reach); }
  Lanes minus_lower() const { return reach.minus_lower; }
  Lanes upper() const { return reach.upper; }
  void extend(const Octet& other) { reach.extend(other.reach); }
};
#endif

inline void bound(Bounds& all, std::span<const Item> items) {
  Octet box = Octet::empty();
  Reach centers = all.centers;
  for (const Item& item : items) {
    const Octet octet = Octet::of(item);
    box.extend(octet);
    const Lanes center = octet.upper() - octet.minus_lower();
    centers.extend(center);
  }
  all.box.extend({box.minus_lower(), box.upper()});
  all.centers = centers;
}

template <class Weight>
inline void fill_with(Histogram& histogram, const Binning& binning, std::span<const Item> items,
                      const Weight& weight) {
  const Lanes lower = binning.lower, scale = binning.scale, last = binning.last, zero = Lanes::all(0);
  for (const Item& item : items) {
    const Octet octet = Octet::of(item);
    const Lanes center = octet.upper() - octet.minus_lower();
    const auto bin = min(max((center - lower) * scale, zero), last).whole();
    for (int k = 0; k < 3; ++k) {
      const auto b = static_cast<std::size_t>(static_cast<std::uint32_t>(bin[k]));
      Histogram::Slab& slab = histogram.slab[b][k];
      Octet all = Octet::of(slab);
      all.extend(octet);
      all.store(&slab);
      histogram.count[b][k] += weight(item);
    }
  }
}

inline void fill(Histogram& histogram, const Binning& binning, std::span<const Item> items, bool are_groups) {
  if (are_groups)
    fill_with(histogram, binning, items, [](const Item& group) { return std::int32_t(size_of(group)); });
  else
    fill_with(histogram, binning, items, [](const Item&) { return 1; });
}

inline void merge(Histogram& histogram, const Histogram& other) {
  for (int i = 0; i < histogram.bins; ++i)
    for (int k = 0; k < 3; ++k) {
      Octet all = Octet::of(histogram.slab[i][k]);
      all.extend(Octet::of(other.slab[i][k]));
      all.store(&histogram.slab[i][k]);
      histogram.count[i][k] += other.count[i][k];
    }
}

/// Extends the three sides, one for each axis, by the slabs of one bin; their half areas.
inline Lanes grow(Octet (&side)[3], const Histogram& histogram, int bin, const Scale& scale) {
  Lanes products[3];
  for (int k = 0; k < 3; ++k) {
    side[k].extend(Octet::of(histogram.slab[bin][k]));
    products[k] = scale.side_areas({side[k].minus_lower(), side[k].upper()});
  }
  return sums_of_three(products[0], products[1], products[2]);
}

inline Cut best_cut(const Histogram& histogram, const Reach& box, std::uint32_t total, const SahCost& cost) {
  // Areas are compared relative to the node's own size, so that they fit a float in scenes of any size.
  const Scale scale(box);
  const int bins = histogram.bins;

  // From the right: the areas of everything from each bin on, for the three axes.
  Lanes right_area[kMaxBins];
  Octet side[3] = {Octet::empty(), Octet::empty(), Octet::empty()};
  for (int i = bins - 1; i > 0; --i) right_area[i] = grow(side, histogram, i, scale);

  // From the left: the other side, and the price of the plane in between. A side with nothing in it has an
  // infinite area and a count of 0, and NaN is never the least.
  for (Octet& s : side) s = Octet::empty();
  Lanes best_cost = Lanes::all(kInfinity), best_bin = Lanes::all(0), left_count = Lanes::all(0);
  const Lanes all_count = Lanes::all(float(total));
  for (int i = 1; i < bins; ++i) {
    const Lanes left_area = grow(side, histogram, i - 1, scale);
    left_count = left_count + Lanes::from(histogram.count[i - 1]);
    const Lanes right_count = all_count - left_count;
    const Lanes price = left_area * cost.tests(left_count) + right_area[i] * cost.tests(right_count);
    best_bin = select_less(price, best_cost, Lanes::all(float(i)), best_bin);
    best_cost = min(price, best_cost);
  }

  Cut cut;
  cut.children_cost = kInfinity;
  for (int k = 0; k < 3; ++k)
    if (best_cost.v[k] < cut.children_cost) {
      cut.children_cost = best_cost.v[k];
      cut.axis = k;
    }
  if (cut.axis < 0) return cut;
  cut.bin = int(best_bin.v[cut.axis]);
  Octet left = Octet::empty(), right = Octet::empty();
  int i = 0;
  for (; i < cut.bin; ++i) {
    left.extend(Octet::of(histogram.slab[i][cut.axis]));
    cut.left_count += std::uint32_t(histogram.count[i][cut.axis]);
  }
  for (; i < bins; ++i) right.extend(Octet::of(histogram.slab[i][cut.axis]));
  cut.left = {left.minus_lower(), left.upper()};
  cut.right = {right.minus_lower(), right.upper()};
  return cut;
}

inline std::size_t part(std::span<Item> items, Item* room, const Binning& binning, int axis, int bin) {
  const float lower = binning.lower.v[axis], scale = binning.scale.v[axis], border = float(bin);
  // Write to both and advance one of them: no branch to guess wrong.
  std::size_t left = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const float center = items[i].upper[axis] - items[i].minus_lower[axis];
    const bool goes_left = !((center - lower) * scale >= border);
    Octet octet;
    std::memcpy(&octet, &items[i], sizeof octet);
    octet.store(&items[left]);
    octet.store(&room[i - left]);
    left += goes_left;
  }
  return left;
}

inline constexpr BinKernels kKernels{bound, fill, merge, best_cut, part};
