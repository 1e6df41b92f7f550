"""Shaders keep to what every driver compiles; the one of the tests takes more."""
import re
import unittest

from targets import SOURCE


def statements():
    for path in sorted((SOURCE / 'shaders').rglob('*')):
        if path.suffix in ('.glsl', '.vert', '.frag'):
            code = re.sub(r'//[^\n]*|^#[^\n]*', '', path.read_text(), flags=re.M)
            for statement in re.split(r'[;{}]', code):
                yield str(path.relative_to(SOURCE)), ' '.join(statement.split())


def outside_parentheses(text):
    while (inner := re.sub(r'\([^()]*\)', '', text)) != text:
        text = inner
    return text


class Shaders(unittest.TestCase):
    # NVIDIA's compiler refuses operands of void ("assignment of incompatible types").
    def test_a_choice_by_a_question_mark_is_a_value(self):
        all_of_them = list(statements())
        self.assertGreater(len(all_of_them), 1000)
        alone = [(path, text) for path, text in all_of_them
                 if '?' in outside_parentheses(text) and not re.search(r'(?<![<>=!])=(?!=)|\breturn\b', text)]
        self.assertEqual(alone, [])


if __name__ == '__main__':
    unittest.main()
