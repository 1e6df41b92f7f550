#include "streaming/http/request_queue.h"

#include <limits>

namespace terrella::http {
namespace {

double rank(const Job& job) {
  const double priority = job.request.priority;
  return priority == priority ? priority : -std::numeric_limits<double>::infinity();
}

}  // namespace

bool ByRank::operator()(const Job* a, const Job* b) const {
  const double rank_a = rank(*a);
  const double rank_b = rank(*b);
  return rank_a != rank_b ? rank_a > rank_b : a->sequence < b->sequence;
}

bool ByDue::operator()(const Job* a, const Job* b) const {
  return a->due != b->due ? a->due < b->due : a->sequence < b->sequence;
}

}  // namespace terrella::http
