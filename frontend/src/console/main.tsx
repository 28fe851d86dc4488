import "@shared/theme/mantine.css";
import { mountPage } from "@shared/ui/Page";
import { Console } from "./Console";
import { loaded, translations } from "./i18n";

// Not `await`: a module that waits at its top would keep the bundler from joining small files.
void loaded.then(() => mountPage({ translations, children: <Console /> }));
