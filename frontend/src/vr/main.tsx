import "@shared/theme/mantine.css";
import { mountPage } from "@shared/ui/Page";
import { Enter } from "./enter/Enter";
import { translations } from "./i18n";

mountPage({ translations, children: <Enter /> });
