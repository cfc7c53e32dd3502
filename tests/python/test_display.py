import html
import re
import unittest
import xml.dom.minidom

import knead
from support import BONNET, sheet, surface


class Displayed(unittest.TestCase):
    def shown(self):
        moved = sheet().step(3)
        curve = knead.new().new("curve", form="circle", radius=2)
        volume = knead.new().new("volume", form="box", size=(3, 2, 1))
        return {"document": knead.open(BONNET), "moved": moved, "shape": next(iter(moved)), "spline": surface(weights=True),
                "curve": curve, "volume": volume.volumes[0], "empty": knead.new()}

    def test_outputs_are_whole_and_small(self):
        for name, value in self.shown().items():
            with self.subTest(name):
                page = value._repr_html_()
                self.assertLess(len(page), 600_000)
                # Nothing is fetched from anywhere: the only address is the name of SVG's namespace.
                text = re.sub(r"// [^\n]*|&quot;[A-Za-z0-9+/=]+&quot;", "", page)  # without comments and packed numbers
                self.assertLessEqual(set(re.findall(r"(?:https?:)?//[\w./]+", text)), {"http://www.w3.org/2000/svg"})
                self.assertNotRegex(page, r"(?i)\b(fetch|import|xmlhttprequest|websocket)\s*\(")
                xml.dom.minidom.parseString(value._repr_svg_())

    def test_the_drawing_is_there_without_scripts(self):
        page = self.shown()["moved"]._repr_html_()
        self.assertIn("&lt;noscript&gt;&lt;svg", page)

    def test_what_has_moved_is_coloured(self):
        doc = sheet()
        self.assertIn("&quot;most&quot;: 0", doc._repr_html_())
        self.assertNotIn("&quot;most&quot;: 0,", doc.step(3)._repr_html_())

    def test_labels_are_text(self):
        doc = knead.new("</script><b>x").new(size=(1, 1), name="</script>")
        page = html.unescape(re.search('srcdoc="([^"]*)"', doc._repr_html_())[1])
        self.assertEqual(page.count("</script>"), 1)


if __name__ == "__main__":
    unittest.main()
