#include "work_precision/picture.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <sstream>

#include "output/gnuplot.h"
#include "output/staged_file.h"

namespace brinell::bench {

namespace {

/// In the order of the points, each once.
template <class Name>
std::vector<std::string> each_once(const Sweep& sweep, const Name& name) {
  std::vector<std::string> names;
  for (const SweepPoint& point : sweep.points) {
    if (std::find(names.begin(), names.end(), name(point)) == names.end()) names.push_back(name(point));
  }
  return names;
}

std::string csv(const Sweep& sweep) {
  std::ostringstream text;
  text.precision(6);
  text << "method,nx,ny,tolerance,increments,seconds,error_of,against,relative_error,certificate,iterations,"
          "convolutions,on_front\n";
  for (const SweepPoint& p : sweep.points) {
    text << p.method << ',' << p.nx << ',' << p.ny << ',' << p.tolerance << ',' << p.increments << ',' << p.seconds
         << ',' << p.quantity << ',' << sweep.reference << ',' << p.error << ',' << p.certificate << ','
         << p.iterations << ',' << p.convolutions << ',' << (p.on_front ? 1 : 0) << '\n';
  }
  return text.str();
}

/// A block of data, in the order of time for a front.
void add_block(std::ostringstream& script, const std::string& name, const Sweep& sweep, bool by_time,
               const std::function<bool(const SweepPoint&)>& wanted) {
  std::vector<SweepPoint> points;
  std::copy_if(sweep.points.begin(), sweep.points.end(), std::back_inserter(points), wanted);
  if (by_time) {
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  }
  script << name << " << EOD\n";
  for (const SweepPoint& p : points) {
    if (!(p.error > 0)) continue;  // no place on a logarithmic axis
    script << p.seconds << ' ' << p.error << ' ' << p.label << '\n';
  }
  script << "EOD\n";
}

const char* swept(SweepKind kind) {
  switch (kind) {
    case SweepKind::tolerance: return "tolerance";
    case SweepKind::grid: return "nodes in x";
    case SweepKind::increments: break;
  }
  return "increments";
}

std::string script(const Sweep& sweep, const std::string& title) {
  static const char* const kColours[] = {"#c04020", "#2060c0", "#20a060", "#8040a0", "#c09020", "#606060"};
  static const int kPoints[] = {5, 7, 9, 11};
  const auto methods = each_once(sweep, [](const SweepPoint& p) { return p.method; });
  const auto quantities = each_once(sweep, [](const SweepPoint& p) { return p.quantity; });
  const bool one_quantity = quantities.size() == 1;
  std::ostringstream data, plot;
  // The front is that of all errors, where there are several.
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    const std::string name = "$front" + std::to_string(q);
    add_block(data, name, sweep, true,
              [&](const SweepPoint& p) { return p.on_front && p.quantity == quantities[q]; });
    plot << (q == 0 ? "plot " : ", \\\n ") << name << " with lines lw 8 lc rgb '#d8d8d8' "
         << (q == 0 ? "title 'Pareto front'" : "notitle");
  }
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const std::string name = "$curve" + std::to_string(q * methods.size() + m);
      add_block(data, name, sweep, false,
                [&](const SweepPoint& p) { return p.method == methods[m] && p.quantity == quantities[q]; });
      // A textbook comes first among the methods, and has the first colour.
      const bool has_textbook = methods.front() == "textbook";
      const std::string shown = one_quantity ? methods[m] == "textbook" ? methods[m] : "brinell, " + methods[m]
                                : methods.size() == 1 ? quantities[q]
                                                      : quantities[q] + ", " + methods[m];
      const std::size_t colour = one_quantity ? m + (has_textbook ? 0 : 1) : q;
      const std::size_t dash = one_quantity ? 0 : m;
      plot << ", \\\n " << name << " with linespoints pt " << kPoints[(one_quantity ? colour : m) % 4] << " dt "
           << dash + 1 << " lc rgb '" << kColours[colour % 6] << "' title " << cli::gnuplot_quoted(shown);
      const bool labelled = one_quantity ? methods[m] != "mixed" : q == 0;  // all quantities have the same times
      if (!labelled) continue;
      plot << ", \\\n " << name << " using 1:2:3 with labels "
           << (one_quantity && methods[m] == "textbook" ? "left offset 0.7,0.4" : "right offset -0.7,-0.4")
           << " font ',9' notitle";
    }
  }
  std::ostringstream script;
  script << data.str() << "set title " << cli::gnuplot_quoted(title) << ".\"\\n\"."
         << cli::gnuplot_quoted((one_quantity ? "error of the " + quantities[0] : "errors") + " against " +
                                sweep.reference)
         << " noenhanced font ',12'\n"
         << "set xlabel 'seconds of CPU time, one thread (labels: " << swept(sweep.kind) << ")'\n"
         << "set ylabel 'relative error'\n"
         << "set logscale xy\nset format y '10^{%L}'\nset format x '%g'\nset grid\nset key top right noenhanced"
         << (methods.size() * quantities.size() > 4 ? " font ',11'\n" : "\n")
         << "set offsets graph 0.05, graph 0.08, graph 0.05, graph 0.05\n"
         << plot.str() << '\n';
  return script.str();
}

}  // namespace

void write(const Sweep& sweep, const std::string& title, const std::filesystem::path& stem) {
  cli::write_file(stem.string() + ".csv", csv(sweep));
  cli::draw_picture(stem, script(sweep, title));
  std::printf("%s.csv, .svg, .png\n", stem.c_str());
  std::fflush(stdout);
}

}  // namespace brinell::bench
