#include "apps/team.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "apps/terminal.hpp"

namespace sunfleck::apps {

bool interruptedAnywhere(Team* team) {
  if (!team) return interrupted();
  const std::string yes = "yes";
  const std::vector<std::string> answers = team->toFirst(interrupted() ? yes : "");
  return team->fromFirst(std::find(answers.begin(), answers.end(), yes) != answers.end() ? yes : "") == yes;
}

double sumOverRanks(Team* team, double value) {
  if (!team) return value;
  double sum = 0.;
  for (const std::string& text : team->toFirst(std::to_string(value))) sum += std::strtod(text.c_str(), nullptr);
  return sum;
}

}  // namespace sunfleck::apps
