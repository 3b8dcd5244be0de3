// Writes sp120.hexcomp and compensation_constants.h of one diagnosed machine.
#include <fstream>
#include <hexdbb/compensation.hpp>
#include <limits>

int main() {
  hexdbb::Model model{hexdbb::Machine()};
  for (const char* name : {"leg_length", "guideway_rotation_xy", "backlash", "pitch_cyclic"}) {
    model.add(hexdbb::find_effect(model.nominal.machine, 1, name));
    hexdbb::Term& term = model.terms.back();
    for (Eigen::Index at = 0; at < term.values.size(); ++at)
      term.values[at] = 0.3 * (1.0 - 0.2 * double(at)) * term.effect->info().parameters.front().prior_sigma;
  }
  const hexdbb::CompensationData data = hexdbb::compensation_of(model, "SP-120 of the test", std::string(64, '0'),
                                                                {0.5, 0.01}, std::numeric_limits<double>::quiet_NaN());
  std::ofstream("sp120.hexcomp", std::ios::binary) << hexdbb::compensation_text(data);
  std::ofstream("compensation_constants.h") << hexdbb::compensation_header(data);
}
