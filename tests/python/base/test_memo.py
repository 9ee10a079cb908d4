"""Results that are remembered with what they belong to."""

from __future__ import annotations

import gc

from stribeck.base.memo import Memo


class Owner:
    """Something that a result belongs to."""


def test_a_result_is_computed_once_for_each_owner_and_question() -> None:
    memo: Memo[Owner, int] = Memo()
    one, other = Owner(), Owner()
    asked = [(one, "a"), (one, "a"), (one, "b"), (other, "a")]
    calls: list[int] = []

    def count() -> int:
        calls.append(0)
        return len(calls)

    assert [memo.of(owner, question, count) for owner, question in asked] == [1, 1, 2, 3]


def test_an_owner_is_not_kept_alive() -> None:
    memo: Memo[Owner, list[int]] = Memo()
    owner = Owner()
    memo.of(owner, None, lambda: [1])
    del owner
    gc.collect()
    assert len(memo) == 0
