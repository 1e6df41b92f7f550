#include "surface/plan/tile_uses.h"

#include <algorithm>

namespace terrella {

void TileUses::clear() {
  uses_.clear();
  entries_.clear();
  std::ranges::fill(table_, kNone);
}

// The place of the tile's index in the table, or the free place for it.
std::size_t TileUses::place(const TileId& id) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t at = TileIdHash{}(id)&mask;
  while (table_[at] != kNone && uses_[table_[at]].id != id) at = (at + 1) & mask;
  return at;
}

void TileUses::grow() {
  table_.assign(std::max<std::size_t>(1024, 2 * table_.size()), kNone);
  for (std::uint32_t k = 0; k < uses_.size(); ++k) table_[place(uses_[k].id)] = k;
}

std::uint32_t TileUses::find(const TileId& id, const TileResidency& residency) {
  if (2 * (uses_.size() + 1) > table_.size()) grow();
  std::uint32_t& index = table_[place(id)];
  if (index != kNone) return index;
  index = static_cast<std::uint32_t>(uses_.size());
  const TileResidency::Entry* entry = entries_.emplace_back(residency.find(id));
  TileUse& use = uses_.emplace_back(TileUse{.id = id});
  if (entry != nullptr) use.state = entry->state, use.slot = entry->slot;
  return index;
}

void TileUses::note(std::uint64_t frame, TileResidency& residency) const {
  for (std::size_t k = 0; k < uses_.size(); ++k) {
    const TileUse& use = uses_[k];
    if (!use.judged && !use.drawn) continue;
    // The entry is the residency's own: the plan knows it as one that it must not change.
    TileResidency::Entry& entry =
        entries_[k] != nullptr ? const_cast<TileResidency::Entry&>(*entries_[k]) : residency.entry(use.id);
    entry.last_seen = frame;
    if (use.drawn) entry.last_drawn = frame;
    if (use.needed) entry.last_needed = frame;
    if (use.state == TileState::outside) entry.state = TileState::outside;
  }
}

}  // namespace terrella
