// SPDX-License-Identifier: MIT
// P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild: "FLIP: A Difference
// Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques
// 3(2), 2020. Section numbers are this paper's. Images are worked on in bands of rows, so that the planes in
// between stay small.
#include "lodestone/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include "lodestone/base/parallel.h"
#include "lodestone/image/colour.h"
#include "lodestone/image/flip_filters.h"

namespace lodestone::image {
namespace {

constexpr uint32_t band_rows = 64;
using Vector = std::array<float, 3>;
using Matrix = std::array<Vector, 3>;

// Linear sRGB to CIE XYZ under D65 (IEC 61966-2-1), and back.
constexpr Matrix to_xyz = {{{0.4123908f, 0.3575843f, 0.1804808f},
                            {0.2126390f, 0.7151687f, 0.0721923f},
                            {0.0193308f, 0.1191948f, 0.9505322f}}};
constexpr Matrix from_xyz = {{{3.2409699f, -1.5373832f, -0.4986108f},
                              {-0.9692436f, 1.8759675f, 0.0415551f},
                              {0.0556301f, -0.2039770f, 1.0569715f}}};
constexpr Vector white = {to_xyz[0][0] + to_xyz[0][1] + to_xyz[0][2],
                          to_xyz[1][0] + to_xyz[1][1] + to_xyz[1][2],
                          to_xyz[2][0] + to_xyz[2][1] + to_xyz[2][2]};

Vector multiply(const Matrix& m, const Vector& v) {
  Vector product;
  for (size_t i = 0; i < 3; ++i) product[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return product;
}

Vector relative_xyz(const Vector& linear) {
  const Vector xyz = multiply(to_xyz, linear);
  return {xyz[0] / white[0], xyz[1] / white[1], xyz[2] / white[2]};
}

// YCxCz, an opponent space that is linear in light, so that filtering in it is filtering light (section 4.1).
Vector opponent(const Vector& linear) {
  const Vector t = relative_xyz(linear);
  return {116 * t[1] - 16, 500 * (t[0] - t[1]), 200 * (t[1] - t[2])};
}

Vector linear_of_opponent(const Vector& yxz) {
  const float y = (yxz[0] + 16) / 116;
  return multiply(from_xyz, {(y + yxz[1] / 500) * white[0], y * white[1], (y - yxz[2] / 200) * white[2]});
}

float lab_curve(float t) {
  constexpr float delta = 6.0f / 29;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
}

// CIELAB, chroma scaled by lightness: the Hunt effect (section 4.1).
Vector hunt_lab(const Vector& linear) {
  const Vector t = relative_xyz(linear);
  const float x = lab_curve(t[0]), y = lab_curve(t[1]), z = lab_curve(t[2]);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

float hyab(const Vector& p, const Vector& q) {
  const float a = p[1] - q[1], b = p[2] - q[2];
  return std::abs(p[0] - q[0]) + std::sqrt(a * a + b * b);
}

// Colour difference 0..1 (section 4.1.3): distances below 0.4 of the largest, green to blue, take 0.95 of the
// range.
float colour_difference(const Vector& p, const Vector& q) {
  constexpr float exponent = 0.7f, knee = 0.4f, share = 0.95f;
  static const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), exponent);
  const float distance = std::pow(hyab(p, q), exponent);
  const float limit = knee * largest;
  if (distance < limit) return share / limit * distance;
  return share + (distance - limit) / (largest - limit) * (1 - share);
}

// `rows` rows of `stride` floats.
struct Plane {
  Plane(size_t row_count, size_t row_floats) : stride(row_floats), data(row_count * row_floats) {}
  float* row(size_t y) { return data.data() + y * stride; }
  const float* row(size_t y) const { return data.data() + y * stride; }
  size_t stride;
  std::vector<float> data;
};

// out[x] += weight * sum over k of kernel[k] * source[x + k - radius], for x in 0..width-1.
void filter_row(const float* source, const Kernel& kernel, float weight, float* out, size_t width) {
  const float* shifted = source - kernel.radius();
  for (const float factor : kernel.weights) {
    const float scale = weight * factor;
    for (size_t x = 0; x < width; ++x) out[x] += scale * shifted[x];
    ++shifted;
  }
}

// The same down the columns of a plane, around its row `y`.
void filter_column(const Plane& source, size_t y, const Kernel& kernel, float weight, float* out,
                   size_t width) {
  const size_t top = y - size_t(kernel.radius());
  for (size_t k = 0; k < kernel.weights.size(); ++k) {
    const float* row = source.row(top + k);
    const float scale = weight * kernel.weights[k];
    for (size_t x = 0; x < width; ++x) out[x] += scale * row[x];
  }
}

// What FLIP sees in a band of rows of one image.
class Band {
 public:
  // Rows `first`..`first + count - 1` of the image.
  Band(const Image& image, const FlipFilters& filters, uint32_t first, uint32_t count)
      : filters_(filters), halo_(size_t(filters.radius)), width_(image.width), count_(count) {
    load(image, first);
    for (size_t c = 0; c < 3; ++c) filter_colour(c);
    detect_features();
  }

  // The colour after the eye's filters, in Hunt-adjusted CIELAB.
  Vector colour(size_t x, size_t y) const {
    Vector linear =
        linear_of_opponent({filtered_[0].row(y)[x], filtered_[1].row(y)[x], filtered_[2].row(y)[x]});
    for (float& component : linear) component = clamp_unit(component);
    return hunt_lab(linear);
  }
  float edge(size_t x, size_t y) const { return edge_.row(y)[x]; }
  float point(size_t x, size_t y) const { return point_.row(y)[x]; }

 private:
  size_t rows() const { return count_ + 2 * halo_; }

  // The opponent planes with `halo_` more pixels on each side; beyond the image its border goes on.
  void load(const Image& image, uint32_t first) {
    const float* colours[3] = {image.find("R")->values.data(), image.find("G")->values.data(),
                               image.find("B")->values.data()};
    source_.assign(3, Plane(rows(), width_ + 2 * halo_));
    for (size_t y = 0; y < rows(); ++y) {
      const int64_t wanted = int64_t(first) + int64_t(y) - int64_t(halo_);
      const size_t line = size_t(std::clamp<int64_t>(wanted, 0, int64_t(image.height) - 1)) * width_;
      for (size_t x = 0; x < width_; ++x) {
        Vector linear;
        for (size_t c = 0; c < 3; ++c) {
          const float value = clamp_unit(colours[c][line + x]);
          linear[c] = image.linear ? value : srgb_decode(value);
        }
        const Vector yxz = opponent(linear);
        for (size_t c = 0; c < 3; ++c) source_[c].row(y)[halo_ + x] = yxz[c];
      }
      for (Plane& plane : source_) {
        float* row = plane.row(y);
        std::fill_n(row, halo_, row[halo_]);
        std::fill_n(row + halo_ + width_, halo_, row[halo_ + width_ - 1]);
      }
    }
  }

  Plane filter_rows(const Plane& source, const Kernel& kernel) const {
    Plane result(rows(), width_);
    for (size_t y = 0; y < rows(); ++y) filter_row(source.row(y) + halo_, kernel, 1, result.row(y), width_);
    return result;
  }

  void filter_colour(size_t channel) {
    Plane& result = filtered_.emplace_back(count_, width_);
    for (const SeparableTerm& term : filters_.sensitivity[channel]) {
      const Plane across = filter_rows(source_[channel], term.kernel);
      for (size_t y = 0; y < count_; ++y)
        filter_column(across, y + halo_, term.kernel, term.weight, result.row(y), width_);
    }
  }

  // Lengths of the gradient and of the second derivative along x and y of the luminance 0..1 (section 4.2).
  void detect_features() {
    for (float& y : source_[0].data) y = (y + 16) / 116;
    const Plane blurred = filter_rows(source_[0], filters_.blur);
    detect(blurred, filters_.edge, edge_);
    detect(blurred, filters_.point, point_);
  }

  void detect(const Plane& blurred, const Kernel& kernel, Plane& length) {
    const Plane across = filter_rows(source_[0], kernel);
    length = Plane(count_, width_);
    std::vector<float> along_x(width_), along_y(width_);
    for (size_t y = 0; y < count_; ++y) {
      std::fill(along_x.begin(), along_x.end(), 0.0f);
      std::fill(along_y.begin(), along_y.end(), 0.0f);
      filter_column(across, y + halo_, filters_.blur, 1, along_x.data(), width_);
      filter_column(blurred, y + halo_, kernel, 1, along_y.data(), width_);
      for (size_t x = 0; x < width_; ++x)
        length.row(y)[x] = std::sqrt(along_x[x] * along_x[x] + along_y[x] * along_y[x]);
    }
  }

  const FlipFilters& filters_;
  size_t halo_, width_, count_;
  std::vector<Plane> source_, filtered_;
  Plane edge_{0, 0}, point_{0, 0};
};

// Section 4.3: a difference in features sharpens the difference in colour.
float combined(const Band& a, const Band& b, size_t x, size_t y) {
  const float colour = std::min(colour_difference(a.colour(x, y), b.colour(x, y)), 1.0f);
  const float edges = std::abs(a.edge(x, y) - b.edge(x, y));
  const float points = std::abs(a.point(x, y) - b.point(x, y));
  const float feature = std::sqrt(std::min(std::max(edges, points) / std::sqrt(2.0f), 1.0f));
  return std::pow(colour, 1 - feature);
}

void check(const Image& a, const Image& b, double pixels_per_degree) {
  if (a.width != b.width || a.height != b.height)
    throw std::invalid_argument("FLIP of images of different sizes");
  for (const Image* image : {&a, &b}) {
    for (const char* name : {"R", "G", "B"}) {
      const Channel* channel = image->find(name);
      if (channel == nullptr || channel->values.size() != image->pixels())
        throw std::invalid_argument("FLIP of an image without R G B");
    }
  }
  if (!(pixels_per_degree > 0 && pixels_per_degree < 10000))
    throw std::invalid_argument("FLIP at no resolution");
}

}  // namespace

std::vector<float> flip_error(const Image& a, const Image& b, double pixels_per_degree) {
  check(a, b, pixels_per_degree);
  const FlipFilters filters = make_flip_filters(pixels_per_degree);
  std::vector<float> errors(a.pixels());
  parallel_for(a.height, band_rows, [&](uint64_t begin, uint64_t end) {
    const Band seen_a(a, filters, uint32_t(begin), uint32_t(end - begin));
    const Band seen_b(b, filters, uint32_t(begin), uint32_t(end - begin));
    for (uint64_t y = begin; y < end; ++y) {
      for (uint32_t x = 0; x < a.width; ++x) errors[y * a.width + x] = combined(seen_a, seen_b, x, y - begin);
    }
  });
  return errors;
}

FlipSummary summarise(const std::vector<float>& errors) {
  if (errors.empty()) return {};
  FlipSummary summary;
  // One order of addition, whatever the threads do.
  summary.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
  std::vector<float> sorted = errors;
  const size_t rank = size_t(std::ceil(0.99 * double(errors.size()))) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + ptrdiff_t(rank), sorted.end());
  summary.p99 = double(sorted[rank]);
  return summary;
}

}  // namespace lodestone::image
