/**
 * @file
 * Tissue in layers with membranes between them: the force with which it holds a needle back.
 *
 * | part | force |
 * |---|---|
 * | cutting | goes to the layer's `cutting_n`, by at most `stiffness_n_per_mm` each millimetre that is cut |
 * | friction | of all that was cut so far, `friction_n_per_mm` of each layer: it grows with the depth |
 * | membrane | `stiffness_n_per_mm` times how far it is pushed in; at `puncture_n` it tears, and the force
 * decays with `relaxation_s` | | texture | noise that changes along the depth, normal, correlated over
 * `texture_mm` | | viscosity | `viscosity_n_s_per_mm` times the speed |
 *
 * Friction turns round over `slip_mm` when the needle does; only a needle that is pushed cuts or leans on a
 * membrane.
 */
#ifndef INTERLOCK_NEEDLE_TISSUE_HPP
#define INTERLOCK_NEEDLE_TISSUE_HPP

#include <cstddef>
#include <vector>

#include "needle/noise.hpp"

namespace interlock::needle {

struct Layer {
  double thickness_mm = 25.0;
  double cutting_n = 0.6;
  double stiffness_n_per_mm = 0.3;
  double friction_n_per_mm = 0.02;
};

struct Membrane {
  double depth_mm = 0.0;
  double stiffness_n_per_mm = 0.8;
  double puncture_n = 2.0;
  double relaxation_s = 0.03;
};

struct TissueParameters {
  std::vector<Layer> layers;       /**< from the skin; below the last one it goes on for ever */
  std::vector<Membrane> membranes; /**< by depth */
  double viscosity_n_s_per_mm = 0.03;
  double slip_mm = 0.3;
  double texture_n = 0.05; /**< standard deviation */
  double texture_mm = 0.5;
};

/** A membrane that tore. */
struct Puncture {
  std::size_t membrane = 0;
  double time_s = 0.0;
  double depth_mm = 0.0;
};

class Tissue {
 public:
  /** There is at least one layer. */
  Tissue(const TissueParameters& parameters, const Noise& noise);

  /** The tip is at this depth one period later; force on the needle, N, positive against its advance. */
  double press(double depth_mm, double period_s);

  const std::vector<Puncture>& punctures() const { return punctures_; }

 private:
  const Layer& layer() const;
  void cut(double way_mm);
  double membranes(double period_s);

  TissueParameters parameters_;
  Noise noise_;
  std::vector<double> torn_n_; /**< of each membrane: force that is left after it tore; below 0: intact */
  std::vector<Puncture> punctures_;
  double time_s_ = 0.0;
  double depth_mm_ = 0.0;
  double deepest_mm_ = 0.0;
  double stick_mm_ = 0.0; /**< where the tissue's grip on the shaft is at rest */
  double cutting_n_ = 0.0;
  double friction_n_ = 0.0;
  double texture_n_ = 0.0;
};

}  // namespace interlock::needle

#endif
